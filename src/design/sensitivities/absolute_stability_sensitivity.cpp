#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "design/sensitivities/controller_sensitivity.hpp"
#include "design/sensitivities/coordinate_sensitivity.hpp"
#include "design/sensitivities/design_parameter.hpp"
#include "design/sensitivities/disc_sensitivity.hpp"
#include "design/sensitivities/two_rate_sensitivity.hpp"
#include "model/known_structure.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/disc_stiffness.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Complex = std::complex<double>;

std::vector<DesignParameter> parameters_of(const Device& free) {
  using Kind = DesignParameter::Kind;
  std::vector<DesignParameter> parameters = design_parameters(free);
  std::erase_if(parameters, [](const DesignParameter& each) {
    return each.kind == Kind::user_mass || each.kind == Kind::user_damping || each.kind == Kind::user_stiffness;
  });
  return parameters;
}

constexpr double same_limit = 1e-6;      // relative
constexpr double rounding_unit = 2e-13;  // relative error of K at w T = 1; it grows as 1/(w T)²

double stiffness_at(const Device& free, const TerminationDiscs& discs, double angle) {
  return least_stiffness(discs.at(angle / free.loop().sampling_period), damper_sensitivity(free, angle, {}).value);
}

/// Steps from rest, rad per sample: large ones keep digits, small ones see slow modes and filters.
constexpr double rest_angle = 3e-3;
constexpr double rest_steps[] = {3.0 * rest_angle, 2.0 * rest_angle, rest_angle, 0.1 * rest_angle, 0.01 * rest_angle};
constexpr double fits_well = 1e-8;  // relative, of the values; slopes bend more

/// From how far the limit at w -> 0 can be extrapolated; nothing where the limit is not reached there.
std::optional<double> step_from_rest(const Device& free, const TerminationDiscs& discs,
                                     const AbsoluteStabilityLimit& limit) {
  const double angle = limit.frequency * free.loop().sampling_period;
  if (angle >= rest_angle) return std::nullopt;
  const double rounding = angle > 0.0 ? rounding_unit / (angle * angle) : 0.0;
  std::optional<double> fitting;
  for (const double step : rest_steps) {
    const double y1 = stiffness_at(free, discs, step);
    const double y2 = stiffness_at(free, discs, 2.0 * step);
    const double y3 = stiffness_at(free, discs, 3.0 * step);
    const double y4 = stiffness_at(free, discs, 4.0 * step);
    const double at_rest = even_parabola(y1, y2, y3, 0.0);
    const double residual = std::abs(even_parabola(y1, y2, y3, 4.0) - y4);
    const bool is_there = std::abs(at_rest - limit.stiffness) <= (same_limit + rounding) * at_rest;
    if (!is_there || !(residual <= smooth_enough * y4)) continue;
    if (residual <= fits_well * y4) return step;
    if (!fitting) fitting = step;
  }
  return fitting;
}

/// f = 1 + 2 Re(C c) + |C|² (|c|² - r²), C = K + B v: 0 where a passive user brings the loop to its limit.
class Condition {
 public:
  Condition(const Device& free, const TerminationDiscs& discs) : free_(free), discs_(discs) {}

  struct Value {
    double f = 0.0;
    double by_stiffness = 0.0;
  };
  [[nodiscard]] Value at(double stiffness, double angle) const {
    const TerminationDiscs::Disc disc = discs_.at(angle / free_.loop().sampling_period);
    const Complex controller = stiffness + damper_sensitivity(free_, angle, {}).value;
    return {1.0 + 2.0 * (controller * disc.centre).real() + std::norm(controller) * disc.power,
            2.0 * disc.centre.real() + 2.0 * controller.real() * disc.power};
  }

 private:
  const Device& free_;
  const TerminationDiscs& discs_;
};

/// Where the limit is reached.
struct Touch {
  double stiffness = 0.0;
  double angle = 0.0;
};

/// The least K near a touch: f = 0 and df/dangle = 0 by Newton's method. absolute_stability_limit() finds it by values of K,
/// which are flat there; and K has a square root's edge where f has no zero beyond, while f stays smooth. Unchanged at
/// the ends of the range, or where the iteration leaves the neighbourhood.
Touch polished(const Device& free, const TerminationDiscs& discs, const Touch& start) {
  constexpr int rounds = 6;
  constexpr double widest_step = 1e-4;  // of the angle
  constexpr double narrowest_step = 1e-7;
  constexpr double of_a_mode = 0.03;      // of its relative width
  constexpr double neighbourhood = 0.03;  // relative
  double share = widest_step;
  for (const Mode& mode : discs.held_form().modes) share = std::min(share, of_a_mode * mode.damping_ratio);
  const double step = std::max(share, narrowest_step) * start.angle;
  if (start.angle + 2.0 * step >= std::numbers::pi) return start;
  const Condition condition(free, discs);
  Touch touch = start;
  for (int i = 0; i < rounds; ++i) {
    const Condition::Value here = condition.at(touch.stiffness, touch.angle);
    const Condition::Value up = condition.at(touch.stiffness, touch.angle + step);
    const Condition::Value down = condition.at(touch.stiffness, touch.angle - step);
    const Condition::Value upper = condition.at(touch.stiffness, touch.angle + 2.0 * step);
    const Condition::Value lower = condition.at(touch.stiffness, touch.angle - 2.0 * step);
    const double slope = (8.0 * (up.f - down.f) - (upper.f - lower.f)) / (12.0 * step);
    const double bend = (16.0 * (up.f + down.f) - (upper.f + lower.f) - 30.0 * here.f) / (12.0 * step * step);
    const double mixed = (up.by_stiffness - down.by_stiffness) / (2.0 * step);
    const double determinant = here.by_stiffness * bend - slope * mixed;
    const double turn = -(here.by_stiffness * slope - mixed * here.f) / determinant;
    touch.angle += turn;
    touch.stiffness -= (here.f + slope * turn) / here.by_stiffness;
    const bool is_near = std::abs(touch.angle - start.angle) <= neighbourhood * start.angle &&
                         std::abs(touch.stiffness - start.stiffness) <= neighbourhood * start.stiffness &&
                         touch.angle + 2.0 * step < std::numbers::pi;
    if (!is_near) return start;
    if (std::abs(turn) <= 1e-10 * touch.angle) break;
  }
  return touch;
}

/// dK/dp = -f_p/f_K at a fixed angle.
std::vector<double> sensitivities_at(const Device& free, const TerminationDiscs& discs, const Touch& touch,
                                     std::span<const DesignParameter> parameters) {
  const double angle = touch.angle;
  const DiscSensitivity sensitivities = disc_sensitivity(free, discs, angle, parameters);
  const DamperSensitivity damper = damper_sensitivity(free, angle, parameters);
  // The discs' own sums, which keep more digits.
  const TerminationDiscs::Disc disc = discs.at(angle / free.loop().sampling_period);
  const Complex c = disc.centre;
  const Complex controller = touch.stiffness + damper.value;
  const auto by_controller = [&](Complex slope) {
    return 2.0 * (slope * c).real() + 2.0 * (std::conj(controller) * slope).real() * disc.power;
  };
  const double by_stiffness = by_controller(1.0);
  std::vector<double> result;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Complex by = sensitivities.centre_by_parameter[i];
    const double by_square = 2.0 * ((std::conj(c) * by).real() - disc.radius * sensitivities.radius_by_parameter[i]);
    const double by_parameter =
        2.0 * (controller * by).real() + std::norm(controller) * by_square + by_controller(damper.by_parameter[i]);
    result.push_back(-by_parameter / by_stiffness);
  }
  return result;
}

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Where the damped bodies hardly move discs are so large that their slopes cancel.
bool is_in_dip(const TerminationDiscs& discs, double frequency) {
  constexpr double far_larger = 1e4;  // a disc, than the free plant
  return !discs.sharp_images().empty() &&
         discs.at(frequency).radius > far_larger * std::abs(response(discs.free_plant(), frequency));
}

DeviceParameters moved_parameters(const Device& free, const std::string& key, double value) {
  DeviceParameters moved = free.parameters();
  set_parameter(moved, key, value);
  return moved;
}

/// The limit itself, without what is taken off it; NaN where the value makes no device.
double limit_along_parameter(const Device& free, const std::string& key, double value) {
  DeviceParameters moved = moved_parameters(free, key, value);
  if (find_problem(moved)) return no_number;
  const VirtualDamper damper{moved.wall.damping, moved.wall.velocity_filter_hz};
  const AbsoluteStabilityLimit limit = absolute_stability_limit(Device(std::move(moved)), damper);
  return limit.stiffness / (1.0 - limit.truncation);
}

/// A slope of a limit reached at nearly zero frequency or in a dip, where all terms grow without bound, held against
/// differences of the limit: the slope where they agree, a better difference where they do not, NaN where that does not settle.
double checked_slope(const Device& free, const DesignParameter& parameter, double slope, double limit) {
  constexpr double nearly = 1e-4;  // of K/p
  constexpr double settles = 1e-5;
  constexpr double step = 1e-3;
  const double p = parameter.value;
  const auto at = [&](double change) { return limit_along_parameter(free, parameter.key, p * (1.0 + change)); };
  // Of second order: about p, or to one side where the other makes no device, such as a longer period that puts a filter
  // above Nyquist.
  const auto makes_device = [&](double change) {
    return !find_problem(moved_parameters(free, parameter.key, p * (1.0 + change)));
  };
  const double side = !makes_device(2.0 * step) ? -1.0 : makes_device(-2.0 * step) ? 0.0 : 1.0;
  const auto difference = [&](double h) {
    if (side == 0.0) return (at(h) - at(-h)) / (2.0 * h * p);
    return side * (4.0 * at(side * h) - at(2.0 * side * h) - 3.0 * at(0.0)) / (2.0 * h * p);
  };
  const double scale = std::max(limit / p, std::isfinite(slope) ? std::abs(slope) : 0.0);
  const double coarse = difference(step);
  if (std::abs(coarse - slope) <= nearly * scale) return slope;
  // Richardson, twice
  const double twice = difference(2.0 * step);
  const double half = difference(0.5 * step);
  const double finer = (4.0 * half - coarse) / 3.0;
  const double rougher = (4.0 * coarse - twice) / 3.0;
  const bool is_settled = std::abs(finer - rougher) <= settles * std::max(limit / p, std::abs(finer));
  return is_settled ? finer : no_number;
}

/// The same for a parameter that grows from 0: the slope where a difference confirms it, else NaN.
double checked_first_slope(const Device& free, const DesignParameter& parameter, double slope, double limit) {
  constexpr double roughly = 0.05;
  constexpr double step = 1e-4;
  using Kind = DesignParameter::Kind;
  double unit = free.loop().sampling_period;
  if (parameter.kind == Kind::body_stiffness || parameter.kind == Kind::link_stiffness) unit = limit;
  if (parameter.kind == Kind::body_damping || parameter.kind == Kind::link_damping ||
      parameter.kind == Kind::wall_damping) {
    unit *= limit;
  }
  const double h = step * unit;
  const double first = limit_along_parameter(free, parameter.key, h);
  const double second = limit_along_parameter(free, parameter.key, 2.0 * h);
  const double difference = (4.0 * first - second - 3.0 * limit) / (2.0 * h);
  const bool is_confirmed = std::abs(difference - slope) <= roughly * std::max(std::abs(slope), 1e-3 * limit / unit);
  return is_confirmed ? slope : no_number;
}

}  // namespace

std::vector<Sensitivity> absolute_stability_sensitivities(const Device& device) {
  require_known_structure(device);
  return absolute_stability_sensitivities(device, known_any_user_limit(device));
}

std::vector<Sensitivity> absolute_stability_sensitivities(const Device& device, const AbsoluteStabilityLimit& limit) {
  require_known_structure(device);
  if (!(limit.stiffness > 0.0) || !std::isfinite(limit.stiffness)) return {};
  const bool has_two_loops = has_damper_loop(device.loop());
  if (has_two_loops && device.parameters().wall.damping == 0.0) {
    return absolute_stability_sensitivities(with_one_rate(device), limit);
  }
  if (has_two_loops && !knows_all_users(device)) require_one_rate(device);
  if (is_of_mechanism(device)) return any_grasp_sensitivities(device, limit);
  const Device free = device_without_user(device);
  if (limit.needs_no_user) {
    std::vector<Sensitivity> own = stiffness_sensitivities(free);
    std::erase_if(own, [](const Sensitivity& each) { return each.key.starts_with("operator."); });
    return own;
  }
  if (has_two_loops) return two_rate_users_sensitivities(device, limit);
  const TerminationDiscs discs(free);
  const std::vector<DesignParameter> parameters = parameters_of(free);
  std::vector<double> sensitivities(parameters.size(), std::numeric_limits<double>::quiet_NaN());
  const std::optional<double> step = step_from_rest(free, discs, limit);
  const double angle = std::min(limit.frequency * free.loop().sampling_period, std::numbers::pi);
  if (step) {
    const auto near_rest = [&](double steps) {
      const double at = steps * *step;
      return sensitivities_at(free, discs, {stiffness_at(free, discs, at), at}, parameters);
    };
    const std::vector<double> y1 = near_rest(1.0);
    const std::vector<double> y2 = near_rest(2.0);
    const std::vector<double> y3 = near_rest(3.0);
    for (std::size_t i = 0; i < parameters.size(); ++i) sensitivities[i] = even_parabola(y1[i], y2[i], y3[i], 0.0);
  } else if (limit.frequency > 0.0) {
    sensitivities = sensitivities_at(free, discs, polished(free, discs, {limit.stiffness, angle}), parameters);
  }
  if (angle < rest_angle || (angle > 0.0 && is_in_dip(discs, limit.frequency))) {
    const double found = limit.stiffness / (1.0 - limit.truncation);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      sensitivities[i] = parameters[i].value != 0.0 ? checked_slope(free, parameters[i], sensitivities[i], found)
                                                    : checked_first_slope(free, parameters[i], sensitivities[i], found);
    }
  }
  std::vector<Sensitivity> result;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!std::isfinite(sensitivities[i])) continue;
    const double value = parameters[i].value;
    result.push_back({parameters[i].key, value, sensitivities[i],
                      value != 0.0 ? std::optional(value / limit.stiffness * sensitivities[i]) : std::nullopt});
  }
  return result;
}

}  // namespace zwidth
