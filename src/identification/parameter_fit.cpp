#include "zwidth/identification/parameter_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "identification/critical_hold.hpp"
#include "identification/fit_solution.hpp"
#include "identification/fit_weights.hpp"
#include "identification/identifiability.hpp"
#include "identification/misfit_doubt.hpp"
#include "identification/residual_checks.hpp"
#include "identification/student_t.hpp"
#include "model/uncertainty_problem.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
using namespace internal;
namespace {

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
  result.lower = std::max(0.0, result.value - two_sided_95 * deviation);
  result.upper = result.value + two_sided_95 * deviation;
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
    const bool is_time = coordinate.key == "loop.delay" || coordinate.key == "actuator.time_constant";
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

std::optional<ClearMisfit> misfit_where_clear(const std::vector<ResponsePoint>& points,
                                              const Eigen::VectorXcd& fitted) {
  constexpr std::size_t many = lines_of_local_misfit;
  ClearMisfit result;
  std::vector<double> frequencies;
  std::vector<double> squares;
  double all = 0.0;
  double local = 0.0;
  if (points.front().variance == 0.0) return std::nullopt;
  // Into the first and the last line leaks what lies outside the band.
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const ResponsePoint& point = points[i];
    if (point.variance == 0.0) return std::nullopt;
    const std::complex<double> model = fitted(static_cast<Eigen::Index>(i));
    const double response = std::max(std::abs(model), std::abs(point.value));
    if (std::sqrt(point.variance) > clear_of_noise * response) continue;
    frequencies.push_back(point.frequency);
    squares.push_back(std::norm(point.value - model) / point.variance);
    const std::size_t lines = squares.size();
    all += squares.back();
    local += squares.back();
    if (lines > many) local -= squares[lines - 1 - many];
    if (lines < many) continue;
    const double misfit = std::sqrt(std::max(0.0, local) / static_cast<double>(many));
    if (misfit > result.local.misfit) result.local = {misfit, frequencies[lines - many], point.frequency};
  }
  if (squares.size() < many) return std::nullopt;
  result.lines = squares.size();
  result.misfit = std::sqrt(all / static_cast<double>(result.lines));
  return result;
}

std::vector<double> mode_frequencies(const Device& device, const std::vector<std::size_t>& locked) {
  const ModalForm form = modal_form(locked_device(device, locked));
  std::vector<double> frequencies;
  for (const Mode& mode : form.modes) frequencies.push_back(mode.frequency);
  if (form.suspended_rigid_body) frequencies.push_back(form.suspended_rigid_body->frequency);
  return frequencies;
}

/// A mode that is missing from the fit may be missing from a side minimum alone: a link whose ends move as one, or that
/// hardly holds them, or two links for one mode. What stands out of the noise anywhere may be such a mode too.
Solution with_missing_mode(const FitModel& model, const FrequencyResponse& response, Solution found,
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
  std::optional<double> missing = missing_mode(residuals, points, modes);
  if (!missing) {
    const auto left = misfit_where_clear(points, fitted);
    if (left && stands_out(*left, response)) missing = std::sqrt(left->local.lowest * left->local.highest);
  }
  if (!missing) return found;
  modes.push_back(*missing);
  return searched_near(modes, model, points, std::move(found), robust_threshold);
}

/// K_CR at the record's sampling period.
double stiffness_at(const FitModel& model, const Eigen::VectorXd& x) {
  DeviceParameters parameters = model.parameters_at(x);
  parameters.loop.sampling_period = *model.sampling_period();
  parameters.wall.filters.clear();  // at the record's rate they may be impossible
  // Of the bare device, as everything that is fitted.
  return critical_stiffness(filtered_plant(sampled_plant(Device(std::move(parameters))), {})).stiffness;
}

/// The model error of the response with its sign turned round, where it fits much better: a position that falls as the
/// force rises. Where noise hides most of the response, the misfit tells better than the model error.
std::optional<double> error_if_turned(const FitModel& model, std::vector<ResponsePoint> points, const ParameterFit& fit,
                                      double robust_threshold) {
  constexpr double suspicious = 0.3;
  constexpr double much_better = 0.3;
  if (fit.model_error < suspicious) return std::nullopt;
  for (ResponsePoint& point : points) point.value = -point.value;
  try {
    const Solution turned = solve(model, points, promising_starts(model, points), robust_threshold);
    const std::optional<double> left = misfit(points, model.response_at(turned.x, fit.frequencies));
    const bool misses_less = left && fit.misfit && *left < much_better * *fit.misfit;
    const bool explains_more = turned.model_error <= much_better * fit.model_error;
    if (!explains_more && !(misses_less && turned.model_error < fit.model_error)) return std::nullopt;
    return turned.model_error;
  } catch (const Error&) {  // then it fits no better
    return std::nullopt;
  }
}

void add_remarks(ParameterFit& fit, const FitModel& model, const std::vector<ResponsePoint>& points) {
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
  if (fit.stiffness_without_hold) {
    fit.remarks.push_back(
        note({.code = FindingCode::held_to_critical_point, .evidence = {{"without", *fit.stiffness_without_hold}}}));
  }
  ResidualChecks checks = check_residuals(fit, points, mode_frequencies(fit.device, model.locked()));
  fit.missing_mode = checks.missing_mode;
  for (Remark& remark : checks.remarks) fit.remarks.push_back(std::move(remark));
  if (fit.model_error_if_turned) {
    fit.remarks.push_back(
        warning({.code = FindingCode::explained_better_if_turned,
                 .evidence = {{"turned", *fit.model_error_if_turned}, {"unexplained", fit.model_error}}}));
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
  if (parameters.loop.delay > 0.0) keys.emplace_back("loop.delay");
  if (parameters.actuator.time_constant > 0.0) keys.emplace_back("actuator.time_constant");
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
  if (free.empty()) throw Error(ErrorCode::invalid_argument, "no parameter is free");
  if (free.size() > max_free_parameters) {
    throw Error(ErrorCode::invalid_argument, fmt::format("{} parameters are free; at most {} can be fitted at once",
                                                         free.size(), max_free_parameters));
  }
  const FitModel model(structure, in_band, free, options.locked);

  const Eigen::VectorXd own = model.position_of(structure.parameters());
  const bool from_data = options.start == ParameterFitOptions::Start::from_data;
  const std::vector<Start> starts =
      from_data ? promising_starts(model, points) : starts_near(model, own, points.back().frequency);
  Solution solution = solve(model, points, starts, options.robust_threshold);
  if (from_data && options.search_widely) {
    solution = searched_widely(model, in_band, std::move(solution), options.robust_threshold);
    solution = with_missing_mode(model, in_band, std::move(solution), options.robust_threshold);
  }
  const Identifiability known = identifiability_at(model, points, solution);
  if (std::ranges::count(known.determined, false) > 0) {
    // What the data leave open depends on the start: it goes to the structure's values as far as the data allow.
    solution = drawn_back(model, points, solution, own, known.determined, options.robust_threshold);
  }
  std::optional<double> without_hold;
  std::vector<Remark> about_the_hold;
  bool held_to_a_guess = false;
  const auto left = misfit_where_clear(points, model.response_at(solution.x, frequencies_of(points)));
  const bool is_explained = left && !stands_out(*left, in_band);
  if (const auto critical = is_explained ? std::nullopt : measured_critical_point(in_band, options)) {
    if (const auto held = hold(model, points, solution, *critical, options.robust_threshold)) {
      without_hold = stiffness_at(model, solution.x);
      solution = *held;
      held_to_a_guess = critical->is_guess;
      about_the_hold = critical->remarks;
    }
  }
  const FitData data = fit_data(points, solution.model_error);
  const ResponseWithSlopes at_solution = model.slopes_at(solution.x, data.frequencies);
  const Eigen::MatrixXd covariance_of_x = widened(
      model, solution.x, known, covariance(at_solution, data, known, options.robust_threshold), response.averages);

  DeviceParameters fitted = model.parameters_at(solution.x);
  ParameterFit fit{.device = Device(fitted),
                   .correlations = strong_correlations(model, known.determined, covariance_of_x),
                   .misfit = misfit(points, at_solution.values),
                   .clear_misfit = misfit_where_clear(points, at_solution.values),
                   .model_error = solution.model_error,
                   .stiffness_without_hold = without_hold,
                   .frequencies = data.frequencies,
                   .remarks = std::move(about_the_hold),
                   .settled = solution.settled,
                   .held_to_a_guess = held_to_a_guess};
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
  fit.model_error_if_turned = error_if_turned(model, points, fit, options.robust_threshold);
  add_remarks(fit, model, points);
  return fit;
}

}  // namespace zwidth
