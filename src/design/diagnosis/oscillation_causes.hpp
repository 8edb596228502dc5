#pragma once

#include <optional>
#include <vector>

#include "zwidth/design/diagnosis.hpp"

namespace zwidth::internal {

// The device with B in its wall, and K where it is known; without its uncertainty.
struct ObservedLoop {
  Device device;
  double frequency = 0.0;  // observed, rad/s
  std::optional<double> amplitude;
  std::optional<double> stiffness;
  WallNumber number = WallNumber::stiffness;  // which the limits are of: B of a damper alone
  Progress progress = {};                     // of the stage of work that looks at it
};

// K, or B of a damper alone; absent where K is not known.
[[nodiscard]] std::optional<double> gain_of(const ObservedLoop& loop);

// Whether the loop is stable at its K, by eigenvalues. The position that nothing holds is no instability.
[[nodiscard]] bool is_stable(const Device& device);

// The device with the first harmonic of its Coulomb friction at that share: body.damping + share * body.coulomb.
[[nodiscard]] Device with_friction_as_damping(const Device& device, double share);

// Of the linear loop with or without the user.
[[nodiscard]] OscillationCandidate linear_candidate(const ObservedLoop& loop, OscillationCause cause,
                                                    const Device& device);
// `loop`: of a device that knows_users_of().
[[nodiscard]] OscillationCandidate user_candidate(const ObservedLoop& loop);
// Absent without an encoder, where K is not known, and where spring and damper run in loops of their own.
[[nodiscard]] std::optional<OscillationCandidate> quantisation_candidate(const ObservedLoop& observed);
// Absent without friction, or where K is not known.
[[nodiscard]] std::optional<OscillationCandidate> friction_candidate(const ObservedLoop& loop);

// How far a candidate that does not fit is from fitting: the sum of |ln| of what would have to be otherwise; infinite
// where nothing helps.
[[nodiscard]] double distance_to_fit(const OscillationCandidate& candidate);
// Whether it fits, or would with each number within a factor of 2.
[[nodiscard]] bool is_near(const OscillationCandidate& candidate);

// Shares of friction as damping from sliding to sticking, relative to the device's own damping or spring.
[[nodiscard]] std::vector<double> friction_shares(const Device& device);

}  // namespace zwidth::internal
