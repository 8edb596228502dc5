#include "design/diagnosis/loop_poles.hpp"

#include <algorithm>
#include <cmath>

#include "design/sensitivities/loops_of_wall.hpp"
#include "design/sensitivities/number_limit.hpp"
#include "infinity.hpp"
#include "model/device_lengths.hpp"
#include "model/poles_at_zero.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth::internal {
namespace {

constexpr double growing = 1e-9;  // |z| - 1 of a pole that grows

double excess_of(std::complex<double> delta) {
  return (2.0 * delta.real() + std::norm(delta)) / (std::abs(1.0 + delta) + 1.0);
}

// Poles at z = 1 that are no instability: a position that nothing holds; of coordinates also motions that the wall does not see.
std::size_t free_positions(const Device& device) {
  const std::size_t held_by_wall = is_position_free(device.parameters()) ? 1 : 0;
  if (!device.parameters().coordinates) return held_by_wall;
  const WeightedPath path{weights_of(device, device.loop().actuated), weights_of(device, device.loop().sensed)};
  const std::size_t seen = poles_at_zero_seen(device, path);
  // Those that are no states already.
  const std::size_t lag = device.parameters().actuator.time_constant > 0.0 ? 1 : 0;
  const std::size_t tracking = device.parameters().sensor.tracking_bandwidth > 0.0 ? 2 : 0;
  const auto states = static_cast<std::size_t>(state_space(device).A.rows());
  const std::size_t left_out = 2 * device.degrees_of_freedom() + lag + tracking - states;
  const std::size_t unseen = poles_at_zero(device) - seen;
  return unseen - std::min(unseen, left_out) + (seen > 0 ? held_by_wall : 0);
}

}  // namespace

LoopPoles::LoopPoles(const Device& device) : stiffness_(*device.parameters().wall.stiffness) {
  if (has_two_loops(device)) {
    two_loops_ = TwoRateDevice(device, device.parameters().wall.damping).as_it_runs(device);
    period_ = two_loops_->period();
    deltas_ = two_loops_->poles_minus_one(stiffness_);
    return;
  }
  const Device seen = in_one_loop(device);
  period_ = seen.loop().sampling_period;
  deltas_ =
      closed_loop_poles_minus_one(sample(state_space(seen), {period_, seen.loop().delay}), seen.parameters().wall);
  for (std::size_t i = free_positions(seen); i-- > 0;) {
    deltas_.erase(std::ranges::min_element(deltas_, {}, [](std::complex<double> delta) { return std::norm(delta); }));
  }
}

bool LoopPoles::is_stable() const {
  return std::ranges::all_of(deltas_, [](const auto& delta) { return excess_of(delta) <= growing; });
}

double LoopPoles::critical_frequency() const {
  const auto least_stable = std::ranges::max_element(deltas_, {}, excess_of);
  return least_stable == deltas_.end() ? 0.0 : frequency_of(*least_stable);
}

std::optional<double> LoopPoles::unstable_frequency(double nearest_to) const {
  std::optional<double> nearest;
  double least = infinity;
  for (const std::complex<double>& delta : deltas_) {
    if (excess_of(delta) <= growing) continue;
    const double frequency = frequency_of(delta);
    const double apart = std::abs(std::log(frequency / nearest_to));
    if (frequency == 0.0 || !(apart < least)) continue;
    least = apart;
    nearest = frequency;
  }
  return nearest;
}

double LoopPoles::frequency_of(std::complex<double> delta) const {
  if (two_loops_) {
    return two_loops_->frequency_of({delta.real(), std::abs(delta.imag())}, stiffness_);
  }
  return std::abs(std::arg(1.0 + delta)) / period_;
}

}  // namespace zwidth::internal
