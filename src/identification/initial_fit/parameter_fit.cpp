#include "zwidth/identification/parameter_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "counted.hpp"
#include "identification/initial_fit/fit_solution.hpp"
#include "identification/initial_fit/fit_weights.hpp"
#include "identification/initial_fit/identifiability.hpp"
#include "identification/initial_fit/missed_mode.hpp"
#include "model/loop_keys.hpp"
#include "model/uncertainty_problem.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double normal_95 = 1.959963984540054;  // deviations on either side

std::vector<ResponsePoint> points_in_band(const FrequencyResponse& response, const ParameterFitOptions& options) {
  std::vector<ResponsePoint> points;
  for (const ResponsePoint& point : response.points) {
    if (options.lowest && point.frequency < *options.lowest) continue;
    if (options.highest && point.frequency > *options.highest) continue;
    points.push_back(point);
  }
  return points;
}

Identifiability identifiability_at(const FitModel& model, const std::vector<ResponsePoint>& points,
                                   const Solution& solution) {
  const FitData data = fit_data(points, solution.model_error);
  return identifiability(model.slopes_at(solution.x, data.frequencies), data);
}

bool is_at_bound(const Coordinate& coordinate, double x) {
  return coordinate.kind == Coordinate::Kind::not_negative && x < 1e-9;
}

ParameterEstimate estimate(const Coordinate& coordinate, double x, bool determined, double variance) {
  ParameterEstimate result{coordinate.key, coordinate.value(x), determined, std::nullopt, std::nullopt, std::nullopt};
  if (is_at_bound(coordinate, x)) result.value = 0.0;
  if (!determined) return result;
  const double deviation = coordinate.slope(x) * std::sqrt(variance);
  if (!std::isfinite(deviation)) {
    result.identifiable = false;
    return result;
  }
  result.standard_deviation = deviation;
  result.lower = std::max(0.0, result.value - normal_95 * deviation);
  result.upper = result.value + normal_95 * deviation;
  return result;
}

std::vector<StrongCorrelation> strong_correlations(const FitModel& model, const std::vector<bool>& determined,
                                                   const Eigen::MatrixXd& covariance) {
  constexpr double strong = 0.95;
  std::vector<StrongCorrelation> result;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < covariance.rows(); ++j) {
      if (!determined[static_cast<std::size_t>(i)] || !determined[static_cast<std::size_t>(j)]) continue;
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      if (scale == 0.0 || std::abs(covariance(i, j)) <= strong * scale) continue;
      result.push_back({model.coordinates()[static_cast<std::size_t>(i)].key,
                        model.coordinates()[static_cast<std::size_t>(j)].key, covariance(i, j) / scale});
    }
  }
  return result;
}

/// The covariance of the values.
std::optional<Uncertainty> uncertainty(const FitModel& model, const Eigen::VectorXd& x,
                                       const Eigen::MatrixXd& covariance) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double slope = model.coordinates()[static_cast<std::size_t>(i)].slope(x(i));
    const double variance = slope * covariance(i, i) * slope;
    if (variance >= smallest_variance && variance <= largest_variance) kept.push_back(i);
  }
  if (kept.empty() || kept.size() > max_uncertain_parameters) return std::nullopt;
  Uncertainty result;
  for (const Eigen::Index i : kept) {
    const Coordinate& row = model.coordinates()[static_cast<std::size_t>(i)];
    result.parameters.push_back(row.key);
    result.covariance.emplace_back();
    for (const Eigen::Index j : kept) {
      const Coordinate& column = model.coordinates()[static_cast<std::size_t>(j)];
      result.covariance.back().push_back(row.slope(x(i)) * covariance(i, j) * column.slope(x(j)));
    }
  }
  return without_rounding(std::move(result));
}

/// What the scatter over the lines does not show: the lines are weighted by variances that are themselves estimates of
/// nu = 2 averages - 2 degrees of freedom, which costs (nu - 2) / (nu - 4) of variance; and, of a device that drifts
/// freely, what leaks from its slow motion into the scale of the response, a common factor of all masses, dampings and
/// stiffnesses.
Eigen::MatrixXd widened(const FitModel& model, const Eigen::VectorXd& x, const Identifiability& known,
                        Eigen::MatrixXd covariance, double averages) {
  constexpr double least_freedom = 6.0;
  constexpr double open_scale = 1e-3;  // one standard deviation
  const double freedom = std::max(least_freedom, 2.0 * averages - 2.0);
  if (averages > 0.0) covariance *= (freedom - 2.0) / (freedom - 4.0);
  const bool is_held = !model.locked().empty() ||
                       std::ranges::any_of(model.structure().bodies(), [](const Body& b) { return b.stiffness > 0.0; });
  if (is_held) return covariance;
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Coordinate& coordinate = model.coordinates()[k];
    const bool is_time = coordinate.key == key_of_delay || coordinate.key == key_of_lag;
    if (!is_time && known.shows(k)) scale(i) = coordinate.kind == Coordinate::Kind::logarithmic ? 1.0 : x(i);
  }
  return covariance + open_scale * open_scale * scale * scale.transpose();
}

std::vector<double> frequencies_of(const std::vector<ResponsePoint>& points) {
  std::vector<double> frequencies(points.size());
  std::ranges::transform(points, frequencies.begin(), &ResponsePoint::frequency);
  return frequencies;
}

std::optional<double> misfit(const std::vector<ResponsePoint>& points, const Eigen::VectorXcd& fitted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].variance == 0.0) return std::nullopt;
    sum += std::norm(points[i].value - fitted(static_cast<Eigen::Index>(i))) / points[i].variance;
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

/// What looks like a mode in what is left may have been passed over by a side minimum alone: a link whose ends move as one, or
/// that hardly holds them, or two links for one mode.
Solution with_missed_mode(const FitModel& model, const FrequencyResponse& response, Solution found,
                          double robust_threshold) {
  const std::vector<ResponsePoint>& points = response.points;
  constexpr double overdamped = 0.5;
  std::vector<double> modes;
  for (const Mode& mode : modal_form(locked_device(Device(model.parameters_at(found.x)), model.locked())).modes) {
    const bool is_in_band = mode.frequency < points.back().frequency && mode.frequency > points.front().frequency;
    if (is_in_band && mode.damping_ratio < overdamped) modes.push_back(mode.frequency);
  }
  const Eigen::VectorXcd fitted = model.response_at(found.x, frequencies_of(points));
  std::vector<std::complex<double>> residuals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    residuals.push_back(points[i].value - fitted(static_cast<Eigen::Index>(i)));
  }
  const std::optional<double> missed = missed_mode(residuals, response, modes);
  if (!missed) return found;
  modes.push_back(*missed);
  return searched_near(modes, model, points, std::move(found), robust_threshold);
}

void add_remarks(ParameterFit& fit) {
  for (const UnidentifiableCombination& each : fit.unidentifiable) {
    if (each.parameters.size() == 1) {
      fit.remarks.push_back(warning({.code = FindingCode::parameter_unidentifiable, .key = each.parameters.front()}));
    } else {
      fit.remarks.push_back(warning({.code = FindingCode::only_combination_identifiable,
                                     .subjects = {{"keys", fmt::format("{}", fmt::join(each.parameters, ", "))}}}));
    }
  }
  for (const ParameterEstimate& each : fit.estimates) {
    if (each.standard_deviation && each.value > 0.0 && *each.standard_deviation > 0.5 * each.value) {
      fit.remarks.push_back(
          warning({.code = FindingCode::parameter_hardly_determined,
                   .evidence = {{"relative_deviation", *each.standard_deviation / each.value}, {"threshold", 0.5}},
                   .key = each.key}));
    }
  }
}

}  // namespace

std::vector<std::string> fittable_parameters(const Device& structure, const std::vector<std::string>& locked) {
  const DeviceParameters& parameters = structure.parameters();
  const auto is_locked = [&](std::size_t body) { return std::ranges::count(locked, parameters.bodies[body].name) > 0; };
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < parameters.bodies.size(); ++i) {
    if (is_locked(i)) continue;
    const std::string key = "body." + parameters.bodies[i].name;
    keys.insert(keys.end(), {key + ".mass", key + ".damping"});
    if (parameters.bodies[i].stiffness > 0.0) keys.push_back(key + ".stiffness");
  }
  for (std::size_t i = 0; i < parameters.links.size(); ++i) {
    if (is_locked(parameters.links[i].first) && is_locked(parameters.links[i].second)) continue;
    const std::string key = "link." + std::to_string(i);
    keys.insert(keys.end(), {key + ".stiffness", key + ".damping"});
  }
  if (parameters.loop.delay > 0.0) keys.emplace_back(key_of_delay);
  if (parameters.actuator.time_constant > 0.0) keys.emplace_back(key_of_lag);
  return keys;
}

bool frees_all(const std::vector<std::string>& free) { return free.empty() || std::ranges::count(free, "all") > 0; }

std::vector<std::string> free_parameters(const Device& structure, const std::vector<std::string>& free,
                                         const std::vector<std::string>& locked) {
  std::vector<std::string> keys;
  if (frees_all(free)) keys = fittable_parameters(structure, locked);
  const std::size_t all = keys.size();
  for (const std::string& given : free) {
    const std::string key = full_parameter_key(structure.parameters(), given);
    const auto end = keys.begin() + static_cast<std::ptrdiff_t>(all);
    if (given != "all" && std::find(keys.begin(), end, key) == end) keys.push_back(key);
  }
  return keys;
}

ParameterFit fit_parameters(const Device& structure, const FrequencyResponse& response,
                            const ParameterFitOptions& options) {
  const std::vector<ResponsePoint> points = points_in_band(response, options);
  FrequencyResponse in_band = response;
  in_band.points = points;
  const std::vector<std::string> free = free_parameters(structure, options.free, options.locked);
  if (free.empty()) throw Error(ErrorCode::invalid_argument, Problem{.code = ProblemCode::nothing_free});
  if (free.size() > max_free_parameters) {
    throw Error(ErrorCode::invalid_argument,
                Problem{.code = ProblemCode::too_many_free,
                        .evidence = {counted("free", free.size()), counted("most", max_free_parameters)}});
  }
  const FitModel model(structure, in_band, free, options.locked);

  const Eigen::VectorXd own = model.position_of(structure.parameters());
  const bool from_data = options.start == ParameterFitOptions::Start::from_data;
  const std::vector<Start> starts =
      from_data ? promising_starts(model, points) : starts_near(model, own, points.back().frequency);
  Solution solution = solve(model, points, starts, options.robust_threshold);
  if (from_data) {
    solution = searched_widely(model, in_band, std::move(solution), options.robust_threshold);
    solution = with_missed_mode(model, in_band, std::move(solution), options.robust_threshold);
  }
  const Identifiability known = identifiability_at(model, points, solution);
  if (std::ranges::count(known.determined, false) > 0) {
    // What the data leave open depends on the start: it goes to the structure's values as far as the data allow.
    solution = drawn_back(model, points, solution, own, known.determined, options.robust_threshold);
  }
  const FitData data = fit_data(points, solution.model_error);
  const ResponseWithSlopes at_solution = model.slopes_at(solution.x, data.frequencies);
  const Eigen::MatrixXd covariance_of_x = widened(
      model, solution.x, known, covariance(at_solution, data, known, options.robust_threshold), response.averages);

  DeviceParameters fitted = model.parameters_at(solution.x);
  ParameterFit fit{.device = Device(fitted),
                   .correlations = strong_correlations(model, known.determined, covariance_of_x),
                   .misfit = misfit(points, at_solution.values),
                   .model_error = solution.model_error,
                   .frequencies = data.frequencies,
                   .settled = solution.settled};
  for (Eigen::Index i = 0; i < solution.x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    fit.estimates.push_back(
        estimate(model.coordinates()[k], solution.x(i), known.determined[k], covariance_of_x(i, i)));
    set_parameter(fitted, fit.estimates.back().key, fit.estimates.back().value);
  }
  fitted.uncertainty = uncertainty(model, solution.x, covariance_of_x);
  fit.device = Device(std::move(fitted));
  for (const std::vector<std::size_t>& combination : known.combinations) {
    fit.unidentifiable.emplace_back();
    for (const std::size_t k : combination) fit.unidentifiable.back().parameters.push_back(model.coordinates()[k].key);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    fit.fitted.push_back(at_solution.values(static_cast<Eigen::Index>(i)));
    fit.residuals.push_back(points[i].value - fit.fitted.back());
  }
  add_remarks(fit);
  return fit;
}

}  // namespace zwidth
