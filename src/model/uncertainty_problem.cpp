#include "model/uncertainty_problem.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "counted.hpp"
#include "eigenvalues.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

// Squares of what a parameter may be.
// What rounding of the file's digits may do, relative to the standard deviations.
constexpr double rounding = 1e-9;

constexpr const char* parameters_key = "uncertainty.parameters";
constexpr const char* assumed_key = "uncertainty.assumed";

DeviceProblem covariance_problem(Problem problem) {
  return device_problem("uncertainty.covariance", std::move(problem));
}

// Beside the parameters: without them, why the table is there at all.
bool says_anything(const Uncertainty& uncertainty) {
  return !uncertainty.warning.empty() || !uncertainty.reasons.empty() || !uncertainty.assumed.empty() ||
         uncertainty.verdict != Trust::Verdict::sound;
}

/// Of `keys`, which stand at `place`: each must be of a number that the device has, once.
std::optional<DeviceProblem> find_key_problem(const DeviceParameters& parameters, const char* place,
                                              const std::vector<std::string>& keys) {
  const std::vector<std::string> known = parameter_keys(parameters);
  std::set<std::string> seen;
  for (const std::string& key : keys) {
    const std::string full = full_parameter_key(parameters, key);
    if (std::ranges::count(known, full) == 0) {
      return device_problem(place, {.code = ProblemCode::no_parameter_of_device, .subjects = {{"name", key}}});
    }
    if (!parameter(parameters, full)) {
      return device_problem(place, {.code = ProblemCode::number_without_value, .subjects = {{"name", key}}});
    }
    if (!seen.insert(full).second) {
      return device_problem(place, {.code = ProblemCode::given_twice, .subjects = {{"name", key}}});
    }
  }
  return std::nullopt;
}

bool is_variance(double value) { return value == 0.0 || (value >= smallest_variance && value <= largest_variance); }

}  // namespace

std::optional<DeviceProblem> find_uncertainty_problem(const DeviceParameters& parameters) {
  const std::vector<std::string>& keys = parameters.uncertainty->parameters;
  if (keys.empty() && !says_anything(*parameters.uncertainty)) {
    return device_problem(parameters_key, {.code = ProblemCode::uncertainty_says_nothing});
  }
  if (keys.size() > max_uncertain_parameters) {
    return device_problem(parameters_key,
                          {.code = ProblemCode::too_many_uncertain,
                           .evidence = {counted("keys", keys.size()), counted("most", max_uncertain_parameters)}});
  }
  if (auto problem = find_key_problem(parameters, parameters_key, keys)) return problem;
  if (auto problem = find_key_problem(parameters, assumed_key, parameters.uncertainty->assumed)) return problem;
  const std::vector<std::vector<double>>& covariance = parameters.uncertainty->covariance;
  const std::size_t n = keys.size();
  if (covariance.size() != n) {
    return covariance_problem({.code = ProblemCode::covariance_rows_missing,
                               .evidence = {counted("rows", covariance.size()), counted("parameters", n)}});
  }
  if (n == 0) return std::nullopt;
  for (std::size_t i = 0; i < n; ++i) {
    if (covariance[i].size() != n) {
      return covariance_problem(
          {.code = ProblemCode::covariance_numbers_missing,
           .evidence = {counted("row", i + 1), counted("numbers", covariance[i].size()), counted("parameters", n)}});
    }
    if (!is_variance(covariance[i][i])) {
      return covariance_problem(
          {.code = ProblemCode::no_variance,
           .evidence = {{"value", covariance[i][i]}, {"least", smallest_variance}, {"most", largest_variance}},
           .subjects = {{"name", keys[i]}}});
    }
  }
  const auto deviation = [&](std::size_t i) { return std::sqrt(covariance[i][i]); };
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(static_cast<int>(n), static_cast<int>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double scale = deviation(i) * deviation(j);
      if (!(std::abs(covariance[i][j] - covariance[j][i]) <= rounding * scale)) {
        return covariance_problem({.code = ProblemCode::covariance_not_symmetric,
                                   .evidence = {counted("row", j + 1),
                                                counted("other", i + 1),
                                                {"value", covariance[j][i]},
                                                {"mirrored", covariance[i][j]}}});
      }
      if (!(std::abs(covariance[i][j]) <= (1.0 + rounding) * scale)) {
        return covariance_problem({.code = ProblemCode::covariance_too_large,
                                   .evidence = {{"value", covariance[i][j]}, {"most", scale}},
                                   .subjects = {{"name", keys[j]}, {"other", keys[i]}}});
      }
      const auto row = static_cast<int>(i);
      const auto column = static_cast<int>(j);
      if (scale > 0.0) correlation(row, column) = correlation(column, row) = covariance[i][j] / scale;
    }
  }
  const double least = symmetric_eigenvalues(correlation).minCoeff();
  if (least < -rounding * static_cast<double>(n)) {
    return covariance_problem({.code = ProblemCode::no_covariance});
  }
  return std::nullopt;
}

LeastKnown least_known(const DeviceParameters& parameters, double of_zero) {
  const Uncertainty& uncertainty = *parameters.uncertainty;
  LeastKnown least;
  for (std::size_t i = 0; i < uncertainty.parameters.size(); ++i) {
    const double value = *parameter(parameters, uncertainty.parameters[i]);
    const double variance = uncertainty.covariance[i][i];
    const double share = value > 0.0 ? variance / (value * value) : of_zero;
    if (variance > 0.0 && share > least.share) least = {i, share};
  }
  return least;
}

Uncertainty given(Uncertainty uncertainty, std::size_t i) {
  std::vector<std::vector<double>>& covariance = uncertainty.covariance;
  const std::vector<double> column = covariance[i];
  for (std::size_t j = 0; j < column.size(); ++j) {
    for (std::size_t k = 0; k < column.size(); ++k) covariance[j][k] -= column[j] * column[k] / column[i];
  }
  const auto at = static_cast<std::ptrdiff_t>(i);
  uncertainty.parameters.erase(uncertainty.parameters.begin() + at);
  covariance.erase(covariance.begin() + at);
  for (std::vector<double>& row : covariance) row.erase(row.begin() + at);
  return without_rounding(std::move(uncertainty));
}

Finding assumed_numbers(const std::vector<std::string>& keys) {
  return {.code = FindingCode::assumed_numbers, .subjects = {{"keys", fmt::format("{}", fmt::join(keys, ", "))}}};
}

Uncertainty without_rounding(Uncertainty uncertainty) {
  std::vector<std::vector<double>>& covariance = uncertainty.covariance;
  const auto n = static_cast<Eigen::Index>(covariance.size());
  Eigen::VectorXd deviations(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    deviations(i) = covariance[k][k] >= smallest_variance ? std::sqrt(covariance[k][k]) : 0.0;
  }
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double both = 0.5 * (covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] +
                                 covariance[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)]);
      const double scale = deviations(i) * deviations(j);
      correlation(i, j) = correlation(j, i) = scale > 0.0 ? both / scale : 0.0;
    }
  }
  const SymmetricEigen eigen = symmetric_eigen(correlation);
  if (eigen.values.minCoeff() < 0.0) {
    correlation = eigen.vectors * eigen.values.cwiseMax(0.0).asDiagonal() * eigen.vectors.transpose();
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double value = deviations(i) * correlation(i, j) * deviations(j);
      covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = value;
      covariance[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = value;
    }
  }
  return uncertainty;
}

}  // namespace zwidth::internal
