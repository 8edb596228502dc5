#include "identification/line_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "identification/evidence/given_numbers.hpp"
#include "identification/evidence/limit_evidence.hpp"
#include "identification/evidence/response_evidence.hpp"
#include "identification/evidence/sum_of_evidence.hpp"
#include "identification/fit/minimise.hpp"
#include "identification/model/device_numbers.hpp"
#include "identification/model/rivals/catalogue.hpp"
#include "identification/verdict/line_bands.hpp"
#include "identification/verdict/profile.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

constexpr const char* delay_of_lines = "loop.delay";
constexpr const char* lag_of_lines = "actuator.time_constant";

/// What is fitted, and from where.
struct LineModel {
  DeviceParameters start;
  std::vector<Number> numbers;
  std::optional<Uncertainty> given;  ///< a prior of these numbers
};

bool is_named(const std::vector<std::string>& keys, const std::string& key) {
  return std::ranges::find(keys, key) != keys.end();
}

/// How large numbers are that show in a response.
RivalSetting setting_of_lines(const DeviceParameters& device, const LineFitSetting& setting) {
  RivalSetting sizes{.device = device, .locked = setting.locked, .rms_force = 1.0, .largest_force = 1.0};
  for (const ResponsePoint& point : setting.response->points) {
    sizes.rms_position = std::max(sizes.rms_position, std::abs(point.value));
    sizes.rms_speed = std::max(sizes.rms_speed, std::abs(point.value) * point.frequency);
  }
  sizes.largest_speed = sizes.rms_speed;
  const double highest = setting.response->points.back().frequency;
  sizes.highest_frequency = highest / (2.0 * std::numbers::pi);
  sizes.sampling_period = setting.response->sampling_period.value_or(1.0 / highest);
  return sizes;
}

LineModel model_of_response(const LineFitSetting& setting) {
  constexpr double typical_delay = 0.5;  // sampling periods
  LineModel model{setting.structure.parameters(), {}, {}};
  std::vector<std::string> free = free_parameters(setting.structure, setting.free, setting.locked);
  if ((setting.frees_lateness || is_named(free, lag_of_lines)) && !is_named(free, delay_of_lines)) {
    const double period = setting.response->sampling_period.value_or(model.start.loop.sampling_period);
    if (model.start.loop.delay == 0.0) model.start.loop.delay = typical_delay * period;
    free.emplace_back(delay_of_lines);
  }
  ParameterFitOptions linear;
  linear.free = free;
  linear.locked = setting.locked;
  model.start = fit_parameters(Device(model.start), *setting.response, linear).device.parameters();
  model.start.uncertainty.reset();

  RivalSetting sizes = setting_of_lines(model.start, setting);
  sizes.frees_lag = setting.frees_lateness || is_named(free, lag_of_lines);
  const TypicalSizes typical{sizes.sampling_period, typical_damping(sizes), sizes.rms_force / sizes.rms_position};
  ModelParts parts;
  for (const std::string& key : free) {
    if (key != lag_of_lines) parts.numbers.push_back(device_number(key, model.start, typical));
  }
  actuator_lag().add(sizes, parts);
  ground_spring().add(sizes, parts);
  model.numbers = std::move(parts.numbers);
  return model;
}

/// A number of a device file as it is fitted to limits, whose prior is elsewhere.
Number given_number(const std::string& key, double value, double deviation) {
  const double open = std::numeric_limits<double>::infinity();
  if (key.ends_with(".mass") || (key.starts_with("link.") && key.ends_with(".stiffness"))) {
    return number_about(key, value, open);
  }
  return {.key = key, .unit = std::max(value, deviation)};
}

/// The part of an uncertainty that is of these numbers.
Uncertainty part_of(const Uncertainty& all, const std::vector<std::size_t>& kept) {
  Uncertainty part;
  for (const std::size_t i : kept) {
    part.parameters.push_back(all.parameters[i]);
    part.covariance.emplace_back();
    for (const std::size_t j : kept) part.covariance.back().push_back(all.covariance[i][j]);
  }
  return part;
}

LineModel model_of_limits(const LineFitSetting& setting) {
  constexpr double known_to = 0.2;  // of each number of a file that says nothing more
  LineModel model{setting.structure.parameters(), {}, {}};
  const std::optional<Uncertainty> file = std::exchange(model.start.uncertainty, {});
  const bool names_none = frees_all(setting.free);
  std::vector<std::string> keys;
  if (!names_none || !file) keys = free_parameters(setting.structure, setting.free);
  if (file && setting.known) {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < file->parameters.size(); ++i) {
      const std::string key = full_parameter_key(model.start, file->parameters[i]);
      const std::optional<double> value = parameter(model.start, key);
      if (!value || !(file->covariance[i][i] > 0.0) || is_named(keys, key)) continue;
      kept.push_back(i);
      model.numbers.push_back(given_number(key, *value, std::sqrt(file->covariance[i][i])));
    }
    if (!kept.empty()) model.given = part_of(*file, kept);
  }
  const double period = model.start.loop.sampling_period;
  for (const std::string& key : keys) {
    const double value = *parameter(model.start, key);
    if (names_none && value == 0.0) continue;  // a file that gives 0 means none
    if (value > 0.0) {
      model.numbers.push_back(number_about(key, value, names_none ? known_to : deviation_of_logarithm));
      continue;
    }
    double damping = 0.0;
    for (const Body& body : model.start.bodies) damping += body.mass / period;
    Number open = device_number(key, model.start, {period, damping, damping / period});
    open.prior_deviation = 1.0;
    model.numbers.push_back(std::move(open));
  }
  if (setting.frees_lateness && model.start.loop.delay == 0.0 && !is_named(keys, delay_of_lines)) {
    model.numbers.push_back({.key = delay_of_lines, .unit = period, .prior_deviation = 1.0});
  }
  return model;
}

/// log K_CR of the bare device; nothing where it has no limit.
std::optional<double> log_limit(DeviceParameters device) {
  device.wall.damping = 0.0;
  if (find_problem(device)) return std::nullopt;
  const CriticalStiffness found = critical_stiffness(Device(std::move(device)));
  const bool is_finite = found.status == StiffnessStatus::finite && found.stiffness > 0.0;
  return is_finite ? std::optional(std::log(found.stiffness)) : std::nullopt;
}

/// Of the numbers, others refitted; 0 for those that a bound holds, which the fit does not move.
Eigen::MatrixXd moved_covariance(const LeastSquaresProblem& problem, const Minimum& best, Eigen::Index count) {
  constexpr double near = 1e-9;
  const Eigen::VectorXd bounds = problem.lowest();
  Eigen::MatrixXd hessian = best.picture.hessian;
  std::vector<Eigen::Index> held;
  for (Eigen::Index i = 0; i < hessian.rows(); ++i) {
    if (best.z(i) > bounds(i) + near) continue;
    hessian.row(i).setZero();
    hessian.col(i).setZero();
    hessian(i, i) = 1.0;
    held.push_back(i);
  }
  Eigen::MatrixXd inverse = hessian.fullPivLu().inverse();
  for (const Eigen::Index i : held) inverse(i, i) = 0.0;
  return inverse.topLeftCorner(count, count);
}

double p_of(const SumOfSquares& squares) {
  if (!(squares.freedom > 0.0) || !std::isfinite(squares.sum)) return 1.0;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(squares.freedom), squares.sum));
}

}  // namespace

std::optional<FittedByLines> fit_lines(const LineFitSetting& setting) {
  constexpr double rise = 1.92;  // 95 %: half the quantile of chi-squared with one degree of freedom
  constexpr int most_begins = 4;
  constexpr MinimiseOptions fine{.most_steps = 60, .least_gain = 1e-4};
  if (!setting.response && setting.limits.empty()) return std::nullopt;
  if (!setting.response && !setting.known && frees_all(setting.free)) return std::nullopt;
  const LineModel model = setting.response ? model_of_response(setting) : model_of_limits(setting);
  if (model.numbers.empty()) return std::nullopt;
  const DeviceFamily family(model.start, model.numbers, setting.locked);
  std::vector<std::shared_ptr<const PartOfEvidence>> parts;
  std::shared_ptr<ResponseEvidence> lines;
  if (setting.response) parts.push_back(lines = std::make_shared<ResponseEvidence>(family, *setting.response));
  const std::vector<MeasuredLimit> walls(setting.limits.begin(), setting.limits.end());
  const auto limits = std::make_shared<LimitEvidence>(family, walls);
  if (!walls.empty()) parts.push_back(limits);
  if (model.given)
    parts.push_back(std::make_shared<GivenNumbers>(family, setting.structure.parameters(), *model.given));
  const SumOfEvidence likelihood(family.numbers(), parts);

  const auto limit = [&](const Eigen::VectorXd& z) { return log_limit(family.device_at(z)); };
  std::optional<Minimum> best = minimise(likelihood, likelihood.start(family.coordinates_of(model.start)), fine);
  if (!best || !limit(best->z)) return std::nullopt;
  const double shared = setting.response ? shared_noise(*setting.response) : 1.0;
  ProfileEnd low;
  ProfileEnd high;
  for (int begins = 0; begins < most_begins; ++begins) {  // an end that is more likely than the best was none
    low = profile_end(likelihood, *best, limit, family.of_device(), -1.0, rise * shared);
    if (!low.found_better) high = profile_end(likelihood, *best, limit, family.of_device(), 1.0, rise * shared);
    const ProfileEnd& better = low.found_better ? low : high;
    if (!better.found_better) break;
    auto again = minimise(likelihood, better.z, fine);
    if (again && limit(again->z)) best = *std::move(again);
  }

  const auto count = static_cast<Eigen::Index>(model.numbers.size());
  FittedByLines found{family.device_at(best->z), family.numbers(), best->z.head(count), {}};
  SumOfSquares left;
  if (lines) {
    const Eigen::MatrixXd moved = moved_covariance(likelihood, *best, count);
    left = squares_of_bands(family, *lines, *setting.response, best->z, moved);
  }
  if (!walls.empty()) {
    // Of limits alone all that is fitted has a prior, which gives way: together they are as many squares as there are limits.
    left.sum += lines ? 2.0 * limits->cost(found.x, {}).value_or(0.0) : 2.0 * best->picture.cost;
    for (const MeasuredLimit& each : walls) left.freedom += each.frequency_hz ? 2.0 : 1.0;
  }
  found.covariance = shared * best->picture.hessian.fullPivLu().inverse().topLeftCorner(count, count);
  found.lower = std::exp(low.value);
  found.value = std::exp(*limit(best->z));
  found.upper = std::exp(high.value);
  found.settled = best->settled && low.settled && high.settled;
  found.chi_squared_of_bands = p_of(left);
  return found;
}

}  // namespace zwidth::internal
