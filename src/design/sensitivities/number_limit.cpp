#include "design/sensitivities/number_limit.hpp"

#include <algorithm>
#include <utility>

#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::internal {
namespace {

NumberLimit of_stiffness(CriticalStiffness critical) {
  NumberLimit limit{critical.stiffness, {}, {}, std::move(critical.trust)};
  const auto crossing = [](const Crossover& each) {
    return NumberLimit::Crossing{each.frequency, each.stiffness, each.limited_by};
  };
  if (critical.limit) limit.at = crossing(*critical.limit);
  for (const Crossover& each : critical.crossovers) limit.crossings.push_back(crossing(each));
  return limit;
}

NumberLimit of_damping(CriticalDamping critical) {
  NumberLimit limit{critical.damping, {}, {}, std::move(critical.trust)};
  const auto crossing = [](const DampingCrossover& each) {
    return NumberLimit::Crossing{each.frequency, each.damping, each.limited_by};
  };
  if (critical.limit) limit.at = crossing(*critical.limit);
  for (const DampingCrossover& each : critical.crossovers) limit.crossings.push_back(crossing(each));
  return limit;
}

}  // namespace

NumberLimit number_limit(const Device& device, WallNumber number) {
  return number == WallNumber::stiffness ? of_stiffness(critical_stiffness(device))
                                         : of_damping(critical_damping(device));
}

NumberLimit unchecked_number_limit(const Device& device, WallNumber number) {
  return number == WallNumber::stiffness ? of_stiffness(unguarded_stiffness(device))
                                         : of_damping(critical_damping(device));
}

bool is_position_free(const DeviceParameters& parameters) {
  if (parameters.wall.stiffness.value_or(0.0) > 0.0 || parameters.user.stiffness > 0.0) return false;
  if (parameters.transfer_function) return parameters.transfer_function->denominator.back() == 0.0;
  return std::ranges::all_of(
      parameters.bodies, [](const Body& body) { return body.stiffness == 0.0; });  // of coordinates: where one sees it
}

WallResponse response_of(const Device& device, WallNumber number, double frequency) {
  const VirtualDamper damper = virtual_damper(device);
  const double period = device.loop().sampling_period;
  if (number == WallNumber::stiffness) return {1.0, damper_response(damper, period, frequency)};
  return {damper_response({1.0, damper.velocity_filter_hz}, period, frequency), 0.0};
}

}  // namespace zwidth::internal
