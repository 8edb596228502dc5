#include "design/synthesis/wall_check.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "design/synthesis/wall_limits.hpp"
#include "model/known_structure.hpp"
#include "model/rate_ratio.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/second_route/pole_count.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr double lowest_checked_angle = 1e-5;
constexpr int points_per_decade = 60;
constexpr int check_bisections = 30;
constexpr double tolerance = 1e-4;                                       // rad, of a phase margin from two routes
constexpr std::array masses_of_users{0.0, 0.1, 1.0, 10.0, 1e3};          // times the device's
constexpr std::array springs_of_users{0.0, 0.1, 1.0, 10.0, 100.0, 1e4};  // times the wall's

Device grown(const Device& walled, double spring, double damper) {
  const Wall& wall = walled.parameters().wall;
  return with_wall(walled, spring * *wall.stiffness, {damper * wall.damping, wall.velocity_filter_hz});
}

void check_stable(const Device& walled, const Progress& progress, Trust& trust) {
  tell(progress, 0.0);
  if (trust.refused()) return;
  const Wall& wall = walled.parameters().wall;
  const double stiffness = *wall.stiffness;
  if (!has_damper_loop(walled.loop())) {
    distrust(agreement(PoleCount(walled), stiffness, true), stiffness, trust);
  } else if (wall.damping == 0.0) {
    check_stable(with_one_rate(walled), progress, trust);
  } else {
    const TwoRateDevice loop(walled, wall.damping);
    distrust(agreement(loop, loop.as_it_runs(walled), stiffness, true), stiffness, trust);
  }
}

/// Of a damper in a loop of its own, poles of the loop as it runs.
bool is_unstable_as_it_runs(const Device& device, double stiffness) {
  const Device runs = device.parameters().wall.damping == 0.0 ? with_one_rate(device) : device;
  if (!has_damper_loop(runs.loop())) return PoleCount(runs).in_double(stiffness).value_or(0) > 0;
  const TwoRateDevice loop(runs, runs.parameters().wall.damping);
  return loop.as_it_runs(runs).unstable_poles(stiffness).value_or(0) > 0;
}

/// With users on a grid of masses and springs: poles outside the circle contradict; those too near it to tell do not.
void check_users(const Device& walled, const Progress& progress, Trust& trust) {
  const double mass = moving_mass(walled);
  const double stiffness = *walled.parameters().wall.stiffness;
  for (const double heavy : masses_of_users) {
    for (const double stiff : springs_of_users) {
      if (trust.refused()) return;
      tell(progress, 0.0);
      DeviceParameters held = walled.parameters();
      held.user = {heavy * mass, 0.0, stiff * stiffness};
      if (find_problem(held)) continue;
      const Device device(std::move(held));
      if (has_damper_loop(device.loop())) {
        if (is_unstable_as_it_runs(device, stiffness)) distrust(Agreement::contradicts, stiffness, trust);
        continue;
      }
      const PoleCount poles(device);
      if (poles.confirms(stiffness, true)) continue;
      const std::optional<int> outside = poles.in_double(stiffness);
      if (!outside || *outside == 0) continue;
      distrust(agreement(poles, stiffness, true), stiffness, trust);
    }
  }
}

/// The loop by the state space alone, without modal form. Of a damper in a loop of its own, the loop of the spring's force: with
/// the device's response G at the damper's period, once with either delay, and z = e^{j(angle + 2 pi k)/N}
///
///     L = K/N sum_k (1 - z^-N)/(1 - z^-1) G_spring(z)/(1 + B v(z) G_damper(z))
class StateSpaceLoop {
 public:
  explicit StateSpaceLoop(const Device& walled)
      : wall_(walled.parameters().wall),
        damper_{wall_.damping, wall_.velocity_filter_hz},
        system_(sample(state_space(walled), {walled.loop().sampling_period, walled.loop().delay})) {
    for (const WallFilter& filter : wall_.filters) sections_.push_back(filter_section(filter, system_.period));
    if (!has_damper_loop(walled.loop()) || wall_.damping == 0.0) return;
    const auto [period, delay] = damper_timing(walled.loop());
    steps_ = static_cast<int>(periods_within(walled.loop().sampling_period, period));
    const double fast = walled.loop().sampling_period / steps_;
    of_spring_ = sample(state_space(walled), {fast, walled.loop().delay});
    of_damper_ = sample(state_space(walled), {fast, delay});
  }

  [[nodiscard]] std::complex<double> at(double angle) const {
    return steps_ > 0 ? of_spring_at(angle) : of_one_rate_at(angle);
  }

 private:
  [[nodiscard]] std::complex<double> of_spring_at(double angle) const {
    std::complex<double> sum;
    for (int alias = 0; alias < steps_; ++alias) {
      const double of_fast = std::remainder((angle + 2.0 * pi * alias) / steps_, 2.0 * pi);
      const double positive = std::abs(of_fast);
      const double frequency = positive / of_spring_.period;
      const std::complex<double> back = std::polar(1.0, -positive);
      const std::complex<double> held = (1.0 - std::polar(1.0, -positive * steps_)) / (1.0 - back);
      const std::complex<double> closed =
          response(of_spring_, frequency) /
          (1.0 + damper_response(damper_, of_spring_.period, frequency) * response(of_damper_, frequency));
      sum += of_fast < 0.0 ? std::conj(held * closed) : held * closed;
    }
    return *wall_.stiffness * sum / static_cast<double>(steps_);
  }

  [[nodiscard]] std::complex<double> of_one_rate_at(double angle) const {
    std::complex<double> value = response(system_, angle / system_.period) *
                                 (*wall_.stiffness + damper_response(damper_, system_.period, angle / system_.period));
    for (const FilterSection& section : sections_) value *= response(section, angle);
    return value;
  }

  Wall wall_;
  VirtualDamper damper_;
  DiscreteStateSpace system_;
  int steps_ = 0;  // of the damper while the spring runs once; 0: they run together
  DiscreteStateSpace of_spring_;
  DiscreteStateSpace of_damper_;
  std::vector<FilterSection> sections_;
};

/// Gain crossovers between the points of a grid, each refined by bisection.
void check_phase(const Device& walled, double phase_margin, const Progress& progress, Trust& trust) {
  const StateSpaceLoop loop(walled);
  const auto count = static_cast<int>(std::ceil(points_per_decade * std::log10(pi / lowest_checked_angle)));
  double last_angle = 0.0;
  double last_gain = 0.0;
  for (int i = count; i >= 0; --i) {
    tell(progress, 0.0);
    const double angle = pi * std::pow(10.0, -static_cast<double>(i) / points_per_decade);
    const double gain = std::abs(loop.at(angle));
    if (i < count && (gain > 1.0) != (last_gain > 1.0)) {
      double low = last_angle;
      double high = angle;
      for (int step = 0; step < check_bisections; ++step) {
        const double middle = std::sqrt(low * high);
        ((std::abs(loop.at(middle)) > 1.0) == (last_gain > 1.0) ? low : high) = middle;
      }
      const double margin = std::abs(std::arg(-loop.at(low)));
      if (margin < phase_margin - tolerance) {
        trust.refuse({.code = FindingCode::wall_phase_margin_contradicts,
                      .evidence = {{"phase_margin_deg", margin * 180.0 / pi},
                                   {"frequency_hz", low / (2.0 * pi * walled.loop().sampling_period)},
                                   {"threshold", phase_margin * 180.0 / pi}}});
        return;
      }
    }
    last_angle = angle;
    last_gain = gain;
  }
}

}  // namespace

void check_wall(const Device& walled, const RecommendationOptions& options, bool any_user, Trust& trust) {
  check_stable(walled, options.progress, trust);
  for (const Device& each :
       {grown(walled, options.gain_margin, 1.0), grown(walled, options.gain_margin, options.gain_margin)}) {
    check_stable(each, options.progress, trust);
    if (any_user) check_users(each, options.progress, trust);
  }
  if (!trust.refused()) check_phase(walled, options.phase_margin, options.progress, trust);
  if (!device_has_user(walled)) return;
  const Device alone = device_without_user(walled);
  check_stable(alone, options.progress, trust);
  if (!trust.refused()) check_phase(alone, options.phase_margin, options.progress, trust);
}

Device without_wall(const Device& device) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness.reset();
  parameters.wall.damping = 0.0;
  parameters.wall.velocity_filter_hz = 0.0;
  // An uncertain number of the wall that is left out says nothing.
  if (find_problem(parameters)) parameters.uncertainty.reset();
  return Device(std::move(parameters));
}

std::optional<Finding> why_negligible(const Device& walled) {
  constexpr double negligible = 1e-6;
  const DeviceParameters& parameters = walled.parameters();
  const double alone = critical_stiffness(walled).stiffness;
  if (!std::isfinite(alone) || *parameters.wall.stiffness >= negligible * alone) return {};
  return Finding{.code = FindingCode::hardly_any_wall_keeps_margins,
                 .evidence = {{"stiffness", *parameters.wall.stiffness, units_of(parameters.motion).stiffness},
                              {"threshold", negligible * alone, units_of(parameters.motion).stiffness}}};
}

}  // namespace zwidth::internal
