#pragma once

#include <vector>

#include "stability/second_route/pole_count.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

// critical_stiffness() of the device's filtered plant, checked by the second route; trust as its public entry point
// says. `poles` is of the device.
[[nodiscard]] CriticalStiffness guarded_stiffness(const Device& device, const FilteredPlant& plant,
                                                  const PoleCount& poles);

// Takes every number out and leaves the trust: the answer is "refused".
void withdraw(CriticalStiffness& critical);

// Stiffnesses at which to count, each with whether the loop is said to be stable there. `gain`: of the plant at mid band, where
// there is no crossover to count beside.
struct Claim {
  double stiffness = 0.0;
  bool stable = true;
};
[[nodiscard]] std::vector<Claim> claims_of(const CriticalStiffness& critical, double gain);
[[nodiscard]] double gain_at_mid_band(const FilteredPlant& plant);

enum class Agreement { agrees, contradicts, undecided };

// Whether the second route, too, finds the loop stable (unstable) at this stiffness. Digits are asked only where double
// precision does not agree.
[[nodiscard]] Agreement agreement(const PoleCount& poles, double stiffness, bool stable);

// The spring that stands for K = 0 where poles are counted with a damper closed: the pole at z = 1 of a position that nothing
// holds would be on the circle.
[[nodiscard]] double weak_spring(const Device& device);

// What the agreement on one stiffness makes of the trust: refused where it contradicts, doubtful where undecided.
void distrust(Agreement agreement, double stiffness, Trust& trust);

}  // namespace zwidth::internal
