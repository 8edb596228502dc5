#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> stability_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{
          wall_not_surely_stable, "wall_not_surely_stable", doubt,
          "the wall of {stiffness} is not surely stable: the 95 % interval of the critical stiffness begins at {lower}",
          "", "stay below that, or identify the device more closely"},
      Phrase{wall_poorly_damped, "wall_poorly_damped", note,
             "the wall is stable, and poorly damped: its phase margin of {phase_margin_deg:.3g}° is less than "
             "{least_deg:.0f}°",
             "what hits it rings for long", "make the wall softer, or ask for one with margins"},
      Phrase{
          interval_open, "interval_open", doubt,
          "the uncertainty of the parameters in the file leaves the critical stiffness open within more than a factor "
          "of 2: measure them more closely"},
      Phrase{second_route_contradicts, "second_route_contradicts", refusal,
             "whether the loop is stable at {stiffness:.6g} is open, so no limit is given: two computations contradict "
             "each other where poles of the device lie close together",
             "", "drop a lag that hardly matters, or merge bodies that move alike"},
      Phrase{second_route_undecided, "second_route_undecided", doubt,
             "nothing confirms the answer at {stiffness:.6g}, so it may be wrong: the loop has too many states for a "
             "second computation, or a pole too near the unit circle",
             "", "shorten the delay or merge bodies that hardly move against each other"},
      Phrase{
          poles_along_circle, "poles_along_circle", refusal,
          "which wall in several directions is the softest unstable one is open, so no limit is given: some motion is "
          "hardly damped, and its poles run along the unit circle",
          "", "give joints and cables the damping that they have"},
      Phrase{touch_without_pole, "touch_without_pole", doubt,
             "the limit of {limit:.6g} may be too low: a pole is to touch the unit circle there, and none does by a "
             "second computation",
             "walls up to it are stable, stiffer ones may be", "merge bodies that move alike"},
      Phrase{slow_instability, "slow_instability", doubt,
             "the device by itself is unstable, but so slowly that a wall of {holding:.3g} holds it, and walls up to "
             "{limit:.6g} are stable: if its numbers were computed, rounding moved a pole that belongs at s = 0",
             "", "write the coefficient that makes it as 0"},
      Phrase{delay_margin_contradicts, "delay_margin_contradicts", doubt,
             "the delay margin is left out: two computations contradict each other on it", "",
             "raise the delay of the loop in steps and analyze each"},
      Phrase{margins_contradict, "margins_contradict", doubt,
             "the margins of phase, delay and disk are left out: two computations contradict each other on them",
             "poles lie too close together to tell them apart"},
      Phrase{disk_margin_contradicts, "disk_margin_contradicts", doubt,
             "the disk margin is left out: it contradicts the margins of gain and phase"},
      Phrase{
          point_margins_left_out, "point_margins_left_out", note,
          "margins of the wall in every direction that are not given are not known: the loop has too many states, or "
          "its poles lie too near to each other or to the circle, for all crossings to be shown",
          "", "judge this wall by the margins given, or along single directions"},
      Phrase{disk_margin_left_out, "disk_margin_left_out", note,
             "the disk margin is left out: the wall is too far below every limit for its search to end",
             "the gain, phase and delay margins of the wall stand",
             "judge this wall by those, or give a stiffness nearer to the limits"},
      Phrase{too_many_states_for_damper, "too_many_states_for_damper", refusal,
             "the damper runs slower than the spring, and the loop over the damper's period has {states:n} states: no "
             "more than {most:n} are followed, so no limit is given",
             "", "shorten the delay of the spring, or run it less often"},
      Phrase{
          left_out_beside_damper_loop, "left_out_beside_damper_loop", note,
          "{?what=disk|the disk margin}{?what=gain|the gain margin of stiffness and damping "
          "together}{?what=long_delays|a delay margin that its search of 16 periods and 80 states did not "
          "reach}{?what=q|Q of eq. 24}{?what=damper|a damper beside it}{?what=any_user|the "
          "limit over all passive users}{?what=any_user_slopes|how the limit over all passive users "
          "changes}{?what=relay|a relay's exact oscillation}{?what=steps|a cycle of the encoder's steps}{?what=notch|a "
          "notch} is left out: {?what=any_user|it is known where the damper runs as fast as the spring or faster, and "
          "their delays differ by whole periods of the damper}{?what=damper|any passive user is known where the damper "
          "runs as fast as the spring or faster, and their delays differ by whole periods of the "
          "damper}{?what=notch|it "
          "would filter spring and damper together, and [loop.damper] runs the damper "
          "apart}{!what=any_user|{!what=damper|{!what=notch|it is known where spring and damper run in one loop, and "
          "[loop.damper] runs the damper apart}}}"},
      Phrase{
          damper_closed_at_own_rate, "damper_closed_at_own_rate", note,
          "the sampled plant is the one that the spring sees: the damper of {damping} is closed at its own {rate_hz}",
          "no wall with another damper follows from it"},
      Phrase{critical_damping_left_out, "critical_damping_left_out", note,
             "the largest damper without a spring is left out", "{reason}",
             "simulate such a damper before it is rendered"},
      Phrase{unstable_with_nobody, "unstable_with_nobody", warning, "the wall is unstable with nobody holding",
             "the file's user alone keeps it stable: it shakes once the hand lets go",
             "stay below the limit with nobody holding"},
      Phrase{stiffer_than_any_user_limit, "stiffer_than_any_user_limit", warning,
             "the wall is stiffer than the limit with any passive user",
             "stable alone only: some user's grasp makes it oscillate",
             "stay below that limit, or give the users whom you expect as a family"},
      Phrase{damper_above_any_user_limit, "damper_above_any_user_limit", warning,
             "the wall has more damping than the limit with any passive user",
             "stable alone only: some user's grasp makes it oscillate", "stay below that limit"},
      Phrase{
          any_grasp_not_known, "any_grasp_not_known", note,
          "the limit over all passive users of a mechanism, who hold its tip in every direction, is not computed here",
          "it is not with a damper in a loop of its own, above 20 coordinates, and where a motion is too slow for the "
          "sampling period"},
      Phrase{any_grasp_not_known_somewhere, "any_grasp_not_known_somewhere", warning,
             "the limit over all passive users is not known along {count} of {of} directions at poses",
             "the least with any passive user may lie there; quantiles and shares count it as 0",
             "look at the poses without that limit, or leave them out"},
      Phrase{
          any_grasp_scanned, "any_grasp_scanned", note,
          "any passive user holds the tip in every direction; his limit is the least at the frequencies looked at, and "
          "not shown to be the least in between",
          ""},
      Phrase{
          any_grasp_bounded, "any_grasp_bounded", note,
          "the limit for any passive user of a wall in every direction lies between two bounds, each the least at the "
          "frequencies looked at",
          ""},
      Phrase{tip_loses_directions, "tip_loses_directions", warning,
             "the pose is singular: the tip moves along {directions:n} direction{directions:s} here and along "
             "{directions_beside:n} beside it{?at_pose|, where a user who grasps it leaves {beside}; at the pose "
             "itself, to which no hand keeps a device, it were {at_pose}}",
             "the limit for any passive user is that beside the pose", "judge the device at poses around it too"},
      Phrase{workspace_poses_singular, "workspace_poses_singular", warning,
             "at {count:n} of {of:n} poses, singular ones, the tip moves along fewer directions than beside them",
             "their limits with any passive user are those beside the pose; along the lost directions none is known",
             "give poses around them too"},
      Phrase{workspace_of_tried_poses, "workspace_of_tried_poses", note,
             "the least is that of {poses:n} pose{poses:s} with {directions:n} direction{directions:s} tried in all"
             "{?refined|, refined between the directions}",
             "between those poses and directions a limit may be less", "give more of them where it is low"},
      Phrase{workspace_poses_refused, "workspace_poses_refused", warning,
             "{count:n} of {of:n} poses are singular, or not reached: no limit is known there", "",
             "poses say why, one by one"},
      Phrase{workspace_directions_refused, "workspace_directions_refused", warning,
             "along {count:n} of {of:n} directions no wall is known: the tip cannot move so, or motors or encoders do "
             "not tell",
             "", "poses say why, one by one"},
      Phrase{workspace_points_not_reached, "workspace_points_not_reached", warning,
             "the tip does not reach {count:n} of {of:n} points from the device's pose", "no limit is known there",
             "give another pose to begin from, or points within reach"},
      Phrase{workspace_beyond_ranges, "workspace_beyond_ranges", warning,
             "at {count:n} of {of:n} poses joints are beyond the ranges that the mechanism's file gives them", "",
             "give poses that the device reaches"},
      Phrase{workspace_along_normals, "workspace_along_normals", note,
             "each limit is that of a wall along one normal; the file's wall acts in every direction at once",
             "its own limit may be less than the least of these", "analyze the device at the poses where it is low"},
      Phrase{workspace_without_user, "workspace_without_user", note,
             "the file's user is left out: the limits are those with nobody holding and with any passive user", ""},
      Phrase{workspace_least_contradicts, "workspace_least_contradicts", doubt,
             "two computations contradict each other on the least limit: {stiffness} and {other}", "",
             "analyze the device at that pose and normal"},
      Phrase{too_many_bodies_for_any_user, "too_many_bodies_for_any_user", note,
             "the limit over all passive users is not computed for {bodies:n} bodies; at most {most:n}",
             "a user may leave less than the critical stiffness given here", "merge bodies whose links hardly give"},
      Phrase{any_user_limit_scanned, "any_user_limit_scanned", note,
             "the limit for any passive user is {?what=bound|a lower bound: every softer wall is safe and some stiffer "
             "ones may "
             "be, as the delays of spring and damper differ by no whole periods of the damper; it is }the least at the "
             "frequencies looked at, and not shown to be the least in between, as it is where spring and damper run in "
             "one "
             "loop"},
      Phrase{any_user_limit_may_miss_frequency, "any_user_limit_may_miss_frequency", doubt,
             "the limit for any passive user may be missed at a frequency at which the damped bodies hardly move: give "
             "the other bodies some damping, or join bodies that move as one"},
      Phrase{any_user_limit_lowered, "any_user_limit_lowered", doubt,
             "a spring or mass at the held body that resonates where the damped bodies hardly move destabilises softer "
             "walls than the limit found for any passive user, which is lowered to that"},
      Phrase{any_user_limit_loose, "any_user_limit_loose", doubt,
             "the limit for any passive user is shown to hold only to {unproven:.1g} of it, which is taken off: the "
             "limit given is safe and may be that much too low",
             "", "check the device's numbers for values that lie many powers of ten apart"},
      Phrase{any_user_limit_truncated, "any_user_limit_truncated", doubt,
             "the sum over aliases leaves {truncation:.1g} of the limit for any passive user, which is taken off: the "
             "device has modes or corners far above the sampling rate"}};
  return phrases;
}

}  // namespace zwidth::internal
