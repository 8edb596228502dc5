#include "stability/margins/confirmed_margins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "stability/limit/guarded_stiffness.hpp"
#include "stability/second_route/pole_count.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth::internal {
namespace {

bool delay_margin_stands(const Device& device, const WallMargins& wall) {
  constexpr double closeness = 1e-6;
  constexpr double most_samples = 1000.0;  // beyond, counting the poles takes longer than all the rest
  if (*wall.delay_margin > most_samples * device.loop().sampling_period) return true;
  for (const bool stable : {true, false}) {
    DeviceParameters delayed = device.parameters();
    delayed.uncertainty.reset();  // its covariance was checked before
    delayed.loop.damper.reset();  // it runs with the spring, and is as late
    delayed.loop.delay += *wall.delay_margin * (stable ? 1.0 - closeness : 1.0 + closeness);
    if (find_problem(delayed)) return true;  // more samples of delay than a device may have
    if (agreement(PoleCount(Device(std::move(delayed))), wall.stiffness, stable) == Agreement::contradicts)
      return false;
  }
  return true;
}

bool phase_margin_stands(const Device& device, const WallMargins& wall) {
  constexpr double rounding = 1e-11;        // of eigenvalues; a pole that nothing moves is as near to the circle
  constexpr Eigen::Index most_states = 40;  // beyond, it would take longer than all the rest
  const DiscreteStateSpace plant = sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
  if (plant.Phi.rows() + static_cast<Eigen::Index>(plant.delay_samples) > most_states) return true;
  const double margin = wall.phase_margin.value_or(std::numbers::pi);
  return std::ranges::none_of(std::array{0.05, 0.1, 0.3, 0.6, 1.0 - 1e-4}, [&](double share) {
    return stability_excess_at_phase(plant, device.parameters().wall, share * margin) > rounding;
  });
}

/// The largest disk that the other margins leave.
double most_alpha(const WallMargins& wall) {
  double most = std::numeric_limits<double>::infinity();
  if (wall.gain_margin) most = std::min(most, 2.0 * (*wall.gain_margin - 1.0) / (*wall.gain_margin + 1.0));
  if (wall.lower_gain_margin) {
    most = std::min(most, 2.0 * (1.0 - *wall.lower_gain_margin) / (1.0 + *wall.lower_gain_margin));
  }
  if (wall.phase_margin) most = std::min(most, 2.0 * std::tan(0.5 * *wall.phase_margin));
  return most;
}

}  // namespace

void confirm_margins(const Device& device, Analysis& analysis) {
  WallMargins& wall = *analysis.wall;
  if (wall.delay_margin && !delay_margin_stands(device, wall)) {
    wall.delay_margin.reset();
    analysis.trust.doubt({.code = FindingCode::delay_margin_contradicts});
  }
  if (wall.stable && wall.stiffness > 0.0 && !phase_margin_stands(device, wall)) {
    wall.phase_margin.reset();
    wall.delay_margin.reset();
    analysis.disk_margin.reset();
    analysis.trust.doubt({.code = FindingCode::margins_contradict});
  }
  constexpr double rounding = 1e-6;
  if (analysis.disk_margin && analysis.disk_margin->alpha > (1.0 + rounding) * most_alpha(wall)) {
    analysis.disk_margin.reset();
    analysis.trust.doubt({.code = FindingCode::disk_margin_contradicts});
  }
}

}  // namespace zwidth::internal
