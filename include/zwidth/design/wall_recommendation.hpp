#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/design/drive_damper.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/force_per_count.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/stability/wall_margins.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// What the wall is to be best at.
enum class WallGoal {
  stiffness,         ///< greatest K
  width,             ///< greatest K B
  critical_damping,  ///< greatest K of those whose contact does not swing: contact_damping_ratio() of 1
  damper,            ///< a damper alone, K = 0: greatest damping in motions of 10 Hz, as fast as a hand's
};

/// What the wall to run has to keep, and what it is to be best at.
struct RecommendationOptions {
  WallGoal goal = WallGoal::stiffness;  ///< what it is best at
  /// Least factor by which the stiffness alone, and the whole force, may grow before any passive user (or nobody)
  /// destabilises the loop; from 1 to 1e5.
  double gain_margin = 2.0;                      // 6 dB
  double phase_margin = std::numbers::pi / 6.0;  ///< least, with nobody and with the file's user; 0 to pi/2 rad
  /// Greatest force per encoder count, N or N m (force_per_count()); > 0. Absent: the actuator's force limit, where that
  /// and the resolution are known: a wall whose force one count takes from end to end is a relay.
  std::optional<double> quantisation_force = {};
  /// The vibration modes may lie anywhere from (1 - uncertainty) to (1 + uncertainty) times their frequency, see with_modal_shift(); from 0
  /// to 0.9; above 0 the device needs a link.
  double modal_frequency_uncertainty = 0.0;
  bool notch = true;          ///< a notch near a mode may be added to the wall's filters; none beside [loop.damper]
  bool alternatives = true;   ///< WallRecommendation::alternatives are searched, and what bounds the wall
  bool drive_damper = false;  ///< WallRecommendation::drive_damper is searched
  std::size_t draws = 100;    ///< of the device's uncertainty, where it has one
  Progress progress = {};     ///< told how far the work is; ends it by throwing
};

/// Checks every member's range, and the device: critical damping needs bodies, uncertain modal frequencies need links.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RecommendationOptions& options, const Device& device);

/// What keeps a number of a wall from being better.
enum class WallBound {
  none,                         ///< nothing: it is as good as it can be, or more of it gains nothing
  any_user,                     ///< the gain margin with some passive user
  gain_margin,                  ///< the gain margin of the device as it is
  phase_margin,                 ///< its phase margin
  quantisation_force,           ///< the force per encoder count
  contact_damping,              ///< the contact would swing
  uncertainty,                  ///< the device is not known better
  modal_frequency_uncertainty,  ///< its modal frequencies are uncertain
};

/// What keeps each number of the wall from being larger.
struct WallBounds {
  WallBound stiffness = WallBound::none;  ///< met first with more K
  /// What bounds K, and lower, with more B, and with a faster velocity filter or none; absent of an alternative (and
  /// where there is no such filter).
  std::optional<WallBound> damping = {};
  std::optional<WallBound> velocity_filter = {};  ///< absent where there is no filter
};

/// A wall and what stands behind it. Checked, see recommend_wall().
struct RecommendedWall {
  /// How it differs from the others.
  enum class Kind {
    recommended,         ///< the one to run
    no_virtual_damper,   ///< a spring alone
    half_damping,        ///< half the damping of the one to run
    more_damping,        ///< 1.5 times its damping
    no_velocity_filter,  ///< the damper's velocity as it comes
    no_notch,            ///< without the notch of the one to run
    stiffest,            ///< the greatest stiffness
    widest,              ///< the greatest product of stiffness and damping
    critically_damped,   ///< the contact is critically damped
  };
  Kind kind = Kind::recommended;    ///< the one to run, or what was changed of it
  Wall wall;                        ///< with the filters that the device's wall has, and the notch behind them
  std::optional<WallFilter> notch;  ///< that of wall.filters which was added
  WallBounds bounded_by;            ///< what keeps each number from being larger
  WallMargins margins;              ///< of the device as it is
  /// absolute_stability_limit() at this B, at least gain_margin times K; the whole force may grow by gain_margin too. Absent for
  /// a transfer function and above most_bodies_for_absolute_stability.
  std::optional<double> absolute_stability_limit;
  std::optional<double> absolute_stability_margin;  ///< absolute_stability_limit / K; absent of a damper alone
  std::optional<double> contact_damping_ratio;      ///< see contact_damping_ratio()
  std::optional<ForcePerCount> force_per_count;     ///< absent without an encoder resolution
  /// absolute_stability_damping() behind this velocity filter, at least gain_margin times B; only of a damper alone, absent as
  /// absolute_stability_limit
  std::optional<double> absolute_stability_damping_limit = {};
};
/// "recommended", "no velocity filter", "stiffest".
[[nodiscard]] std::string_view words_of(RecommendedWall::Kind kind);

/// The wall to run, and what else could be run.
struct WallRecommendation {
  /// Whether there is one.
  enum class Status {
    found,
    none,       ///< no wall keeps what is asked
    unbounded,  ///< no stiffness is too much: there is nothing to recommend
    refused,    ///< see trust
  };
  Status status = Status::none;               ///< found, or why not
  std::optional<RecommendedWall> wall;        ///< only where found
  std::optional<Finding> reason;              ///< why there is none; absent where found and where refused
  std::vector<RecommendedWall> alternatives;  ///< the trade-off: other goals, dampers, filters
  /// At how many modal shifts, evenly over the range asked, each wall was held against its margins; 1: at none
  /// but their own frequencies.
  std::size_t modal_shifts_checked = 1;
  /// The wall with the damper on the drive, which keeps the same margins: K, B and gain by `wall`. Where it is asked for with
  /// the goals stiffness and width; absent as with_damper_on_drive(), and where no wall with such a damper is found.
  std::optional<DriveDamper> drive_damper = {};
  HoldingLimits limits;         ///< of the device with its own damper and filters; NaN where refused
  Trust trust;                  ///< of the whole answer
  std::vector<Remark> remarks;  ///< what is worth knowing beside it
};

/// The damping ratio of a device on its wall: the least of the closed-loop poles z = e^{sT} up to twice the natural
/// frequency of the rigid device on it, |s| <= 2 sqrt((K + k)/m); 1 where none of them swings. Vibration modes that
/// low count too. Absent for a transfer function, without wall.stiffness > 0, with a damper in a loop of its own, and where no
/// pole is that low.
[[nodiscard]] std::optional<double> contact_damping_ratio(const Device& device);

/// The wall to render: K, B, velocity filter, and a notch where it is worth 5 % of the goal.
///
///     gain_margin K < absolute_stability_limit(B),   f K < absolute_stability_limit(f B) for f = sqrt(gain_margin), gain_margin
///     margins of the device as it is >= gain_margin, phase_margin
///     force per count <= ripple
///
/// WallGoal::damper asks for a damper alone: K = 0, and gain_margin B lies below absolute_stability_damping() and below
/// critical_damping() with nobody and with the device's [operator]. B says little behind a slow filter: no filter or
/// the one of seven is taken with the greatest Im(B v)/w at 10 Hz (a tenth of Nyquist, where that is lower). No notch
/// is tried.
///
/// The device's own wall.stiffness, damping and velocity_filter_hz are left out; its filters stay. A search on a grid
/// of frequencies over B and the filters, from none down to twice the frequency at which the device oscillates or a
/// hundredth of the sampling rate: a local optimum. What is proposed is computed exactly. A second route that shares
/// nothing with it checks the proposal: closed-loop poles by matrix exponential of the loop, of the loop grown by the
/// gain margin and of that held by passive users, and the phase margin from the state space. The answer is `refused`
/// where the two contradict each other.
/// With an uncertainty of the modal frequencies the wall keeps the margins, every user's too, at 41 modal shifts evenly over the range, and a
/// notch lowers no absolute stability limit at any of them; the contact's damping is that at their nominal values.
/// The wall of an uncertain device keeps all of this in 97.5 % of `draws` devices drawn from the uncertainty. Where
/// absolute_stability_limit() is not available the device as it is decides, and a remark says so.
/// With a faster damper in a loop of its own ([loop.damper]) the same limits and the same check hold, the phase margin is of the
/// spring's force with the damper closed, and neither a notch nor (but for a bound on the force per count) a velocity filter is
/// searched. With a slower one, or delays that differ by no whole number of the damper's periods, no limit over all passive users
/// is known: Error (invalid_argument), as for WallGoal::critical_damping with two rates.
/// Throws Error (invalid_argument) where find_problem() finds one.
[[nodiscard]] WallRecommendation recommend_wall(const Device& device, const RecommendationOptions& options = {});

}  // namespace zwidth
