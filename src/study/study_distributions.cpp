#include "zwidth/study/study_distributions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "counted.hpp"
#include "eigenvalues.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

constexpr double least_eigenvalue = 1e-9;  // of a correlation: below, rounding decides its sign

using Matrix = std::vector<std::vector<double>>;

std::optional<DeviceProblem> find_correlation_problem(const Matrix& correlation, std::size_t count) {
  if (correlation.empty()) return std::nullopt;
  const auto problem = [](Problem found) { return device_problem("correlation.matrix", std::move(found)); };
  if (correlation.size() != count) {
    return problem(
        {.code = ProblemCode::rows_not_one_a_parameter,
         .evidence = {internal::counted("rows", correlation.size()), internal::counted("parameters", count)}});
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (correlation[i].size() != count) {
      return problem(
          {.code = ProblemCode::row_of_other_length,
           .evidence = {internal::counted("length", correlation[i].size()), internal::counted("parameters", count)}});
    }
  }
  Eigen::MatrixXd matrix(count, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (correlation[i][i] != 1.0)
      return problem({.code = ProblemCode::diagonal_not_one, .evidence = {{"value", correlation[i][i]}}});
    for (std::size_t j = 0; j < count; ++j) {
      const double value = correlation[i][j];
      if (!(std::abs(value) <= 1.0))
        return problem({.code = ProblemCode::no_correlation, .evidence = {{"value", value}}});
      if (value != correlation[j][i]) {
        return problem(
            {.code = ProblemCode::not_symmetric, .evidence = {{"value", value}, {"other", correlation[j][i]}}});
      }
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value;
    }
  }
  const double least = internal::symmetric_eigenvalues(matrix).minCoeff();
  if (least < least_eigenvalue) {
    return problem({.code = ProblemCode::not_positive_definite, .evidence = {{"eigenvalue", least}}});
  }
  return std::nullopt;
}

/// What is wrong with the device where one number is at an end of its distribution.
std::optional<DeviceProblem> find_reach_problem(const Device& device, const StudyParameter& one,
                                                const std::string& place) {
  const QuantileFunction quantile(one.distribution);
  for (const double value : {quantile.least(), quantile.largest()}) {
    DeviceParameters parameters = device.parameters();
    parameters.uncertainty.reset();
    set_parameter(parameters, one.key, value);
    const auto problem = find_problem(parameters);
    if (!problem) continue;
    Problem reaches{.code = ProblemCode::reaches_no_device,
                    .evidence = {{"value", value}},
                    .subjects = {{"name", one.key},
                                 {"key", problem->key},
                                 {"what", problem->what},
                                 {"allowed", problem->allowed},
                                 {"end", value == quantile.least() ? "lower" : "upper"}}};
    if (one.distribution.kind == Distribution::Kind::discrete) reaches.evidence.push_back({"discrete", 1.0});
    return device_problem(place, std::move(reaches));
  }
  return std::nullopt;
}

std::size_t index_of_uncertain(const Device& device, const std::string& key) {
  const auto& uncertainty = device.parameters().uncertainty;
  if (!uncertainty) return std::string::npos;
  const std::string full = full_parameter_key(device.parameters(), key);
  for (std::size_t i = 0; i < uncertainty->parameters.size(); ++i) {
    if (full_parameter_key(device.parameters(), uncertainty->parameters[i]) == full) return i;
  }
  return std::string::npos;
}

/// Cholesky's root, row by row.
Matrix root_of(const Matrix& correlation) {
  Matrix root(correlation.size());
  for (std::size_t i = 0; i < correlation.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = correlation[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= root[i][k] * root[j][k];
      root[i].push_back(i == j ? std::sqrt(rest) : rest / root[j][j]);
    }
  }
  return root;
}

}  // namespace

std::optional<DeviceProblem> find_problem(const Device& device, const StudyDistributions& distributions) {
  const auto& parameters = distributions.parameters;
  if (parameters.empty()) return device_problem("parameter", {.code = ProblemCode::no_parameters});
  if (parameters.size() > most_study_parameters) {
    return device_problem("parameter", {.code = ProblemCode::too_many_parameters,
                                        .evidence = {internal::counted("parameters", parameters.size()),
                                                     internal::counted("most", most_study_parameters)}});
  }
  const std::vector<std::string> known = parameter_keys(device.parameters());
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string place = fmt::format("parameter.{}", i);
    std::string key = full_parameter_key(device.parameters(), parameters[i].key);
    if (std::ranges::find(known, key) == known.end()) {
      return device_problem(place + ".key", {.code = ProblemCode::no_number_of_device,
                                             .evidence = {{"quoted", 1.0}},
                                             .subjects = {{"name", parameters[i].key},
                                                          {"numbers", fmt::format("{}", fmt::join(known, ", "))}}});
    }
    if (std::ranges::find(seen, key) != seen.end()) {
      return device_problem(place + ".key",
                            {.code = ProblemCode::given_twice, .subjects = {{"name", parameters[i].key}}});
    }
    seen.push_back(std::move(key));
    if (const auto problem = find_problem(parameters[i].distribution)) {
      return device_problem(fmt::format("{}.{}", place, problem->member), problem->problem.value());
    }
    if (auto problem = find_reach_problem(device, parameters[i], place)) return problem;
  }
  return find_correlation_problem(distributions.correlation, parameters.size());
}

std::optional<Distribution> uncertainty_of(const Device& device, const std::string& key) {
  const std::size_t i = index_of_uncertain(device, key);
  if (i == std::string::npos) return std::nullopt;
  const auto centre = parameter(device.parameters(), key);
  if (!centre) return std::nullopt;
  return Distribution{.kind = Distribution::Kind::normal,
                      .centre = *centre,
                      .deviation = std::sqrt(device.parameters().uncertainty->covariance[i][i])};
}

double uncertain_correlation(const Device& device, const std::string& one, const std::string& other) {
  const std::size_t i = index_of_uncertain(device, one);
  const std::size_t j = index_of_uncertain(device, other);
  if (i == std::string::npos || j == std::string::npos) return 0.0;
  const auto& covariance = device.parameters().uncertainty->covariance;
  const double scale = std::sqrt(covariance[i][i]) * std::sqrt(covariance[j][j]);
  return scale > 0.0 ? std::clamp(covariance[i][j] / scale, -1.0, 1.0) : 0.0;
}

StudyInputs::StudyInputs(const StudyDistributions& distributions) {
  if (const auto problem = find_correlation_problem(distributions.correlation, distributions.parameters.size())) {
    throw Error(ErrorCode::invalid_argument, fmt::format("{} {}; {}", problem->key, problem->what, problem->allowed));
  }
  for (const StudyParameter& each : distributions.parameters) quantiles_.emplace_back(each.distribution);
  const Matrix& correlation = distributions.correlation;
  correlated_.assign(size(), false);
  for (std::size_t i = 0; i < correlation.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (correlation[i][j] != 0.0) correlated_[i] = correlated_[j] = true;
    }
  }
  if (std::ranges::find(correlated_, true) != correlated_.end()) root_ = root_of(correlation);
}

void StudyInputs::from_uniform(std::span<double> numbers) const {
  if (!root_.empty()) {
    for (std::size_t j = 0; j < size(); ++j) numbers[j] = standard_normal_score(numbers[j]);
    return from_normal(numbers);
  }
  for (std::size_t j = 0; j < size(); ++j) numbers[j] = quantiles_[j](numbers[j]);
}

void StudyInputs::correlate(std::span<double> scores) const {
  for (std::size_t i = root_.size(); i-- > 0;) {  // from the last: each needs those before it as they were
    double score = 0.0;
    for (std::size_t k = 0; k <= i; ++k) score += root_[i][k] * scores[k];
    scores[i] = score;
  }
}

void StudyInputs::from_normal(std::span<double> numbers) const {
  correlate(numbers);
  for (std::size_t j = 0; j < size(); ++j) numbers[j] = quantiles_[j].at_score(numbers[j]);
}

}  // namespace zwidth
