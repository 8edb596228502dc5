#pragma once

#include <cstdint>

namespace zwidth {

/// What zwidth may find, in one list. name_of() of words/finding_text.hpp is the name in documents.
enum class FindingCode : std::uint16_t {
  // anywhere
  stated,          ///< a file or a user says so, in the sentence `reason`
  left_out,        ///< `what` is not given, for `reason`
  nobody_holding,  ///< `reason` holds of the device that nobody holds
  not_converged,   ///< a computation did not come to its end, for `reason`

  // model: the device's numbers
  untrusted_without_reason,  ///< the device file doubts its numbers and gives no reason
  assumed_numbers,           ///< numbers of the device that were assumed, not measured
  period_too_short,          ///< a sampling period that no haptic device has
  period_too_long,           ///< a sampling period that no haptic device has: the time is likely in `likely_unit`
  late_beyond_drives,        ///< delay and lag of more sampling periods than drives have
  mass_too_large,            ///< a mass that no haptic device has
  inertia_too_large,         ///< an inertia that no haptic device has

  // stability
  wall_not_surely_stable,             ///< the wall lies within the interval of the critical stiffness
  interval_open,                      ///< the parameters' uncertainty leaves the limit open within more than a factor of 2
  second_route_contradicts,           ///< two computations contradict each other on one wall's stability
  second_route_undecided,             ///< no second computation confirms one wall's stability
  touch_without_pole,                 ///< the limit is a pole's touch of the circle that a second computation does not find
  slow_instability,                   ///< the free device is unstable so slowly that rounded coefficients explain it
  delay_margin_contradicts,           ///< two computations contradict each other on the delay margin
  margins_contradict,                 ///< two computations contradict each other on phase, delay and disk margin
  disk_margin_contradicts,            ///< the disk margin is larger than gain and phase margins allow
  disk_margin_left_out,               ///< its search does not end: the wall is far below every limit
  critical_damping_left_out,          ///< the largest damper alone is not sure, for `reason`
  unstable_with_nobody,               ///< the file's user alone keeps the wall stable
  stiffer_than_any_user_limit,        ///< some user's grasp makes the wall oscillate
  damper_above_any_user_limit,        ///< some user's grasp makes the damper oscillate
  too_many_bodies_for_any_user,       ///< the limit over all passive users is not computed for so many bodies
  any_user_limit_may_miss_frequency,  ///< the damped bodies hardly move at some frequency that may be missed
  any_user_limit_lowered,             ///< a tuned user destabilises softer walls than the bound found: it is lowered
  any_user_limit_loose,               ///< the bound is proven to a share only, which is taken off
  any_user_limit_truncated,           ///< the sum over aliases leaves a share, which is taken off
};

}  // namespace zwidth
