#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/design/drive_damper.hpp"
#include "zwidth/design/notch_design.hpp"
#include "zwidth/design/wall_number.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// What is to be reached, and how far to look.
struct DesignTargetOptions {
  double stiffness = 0.0;                                  ///< the limit to reach, of a damper alone its B; > 0
  StiffnessGoal goal = StiffnessGoal::critical_stiffness;  ///< which limit is to reach it
  double factor = 1000.0;  ///< each number is followed from p / factor to p * factor; above 1, at most 1e6
  std::optional<double> times_now = {};         ///< instead of a stiffness: so many times the limit of the device; > 0
  WallNumber limit_of = WallNumber::stiffness;  ///< damping: the largest damper alone is to reach it
  Progress progress = {};                       ///< told how far the work is; ends it by throwing
};

/// Checks the stiffness (or times_now), the factor and the device: the absolute stability limit needs a body to hold, and not too
/// many.
[[nodiscard]] std::optional<OptionProblem> find_problem(const DesignTargetOptions& options, const Device& device);

/// What one number of the device file alone would have to be.
struct DesignTarget {
  std::string key;                     ///< as in model/parameter.hpp
  double value_now = 0.0;              ///< p, in the unit of its key
  std::optional<double> value_needed;  ///< the nearest p at which the limit is the target; absent: there is none
  Finding why;                         ///< what limits there, or why no value is enough
  /// absolute_stability_limit() at the value needed; infinite where nobody can destabilise a wall, absent where there is no value,
  /// no body to hold, or the limit is not found.
  std::optional<double> absolute_stability_limit_then;
  std::optional<bool> safe;  ///< known to be no lower then than now; absent where that of now is not known
};

/// The ways to a stiffness, the cheapest first: least relative change |ln(needed/now)|; then numbers that are 0 in the
/// device, in the order of its file; then those that lower the limit with any passive user, in the same order; last
/// those that do not get there.
struct DesignTargets {
  std::optional<double> target;     ///< the limit to reach; absent where it is a multiple of a limit that is not finite
  std::optional<double> limit_now;  ///< of the device as it is; infinite where unbounded, absent where refused
  std::optional<double> absolute_stability_limit_now;  ///< of the device as it is; absent as the limit then
  std::vector<DesignTarget> targets;                   ///< cheapest relative change first
  /// What the damper on the drive allows, at the B with the greatest limit over all passive users: no number of the file moved
  /// but an addition to it. Absent as with_damper_on_drive(), for WallNumber::damping, and where no finite limit is
  /// found.
  std::optional<DriveDamper> drive_damper = {};
  HoldingLimits limits;         ///< of the device as it is; NaN where refused
  Trust trust;                  ///< of the whole answer
  std::vector<Remark> remarks;  ///< what is worth knowing beside it
};

/// For each number p of the device that the limit depends on: the value nearest to today's at which the limit reaches
/// the target. The user's numbers are left out.
///
///     K(p) = target,  p alone varied
///
/// p moves by equal factors (a twelfth of a decade; a sixth for the absolute stability limit) both ways within `factor` and the
/// range that makes a device, from 0 upwards; the first change of sign of K(p) - target is refined until K is the
/// target to 1e-10, or, where the limit jumps across it, to the jump's side that has the target. A scan: a limit that
/// passes the target twice within one step is passed over. For the absolute stability limit of more than four bodies only those
/// numbers are followed that move it most, by a factor of 10 at most: a remark says how many. Each needed value is
/// confirmed by critical_stiffness(Device) or absolute_stability_limit(), and judged for any passive user.
/// With a damper in a loop of its own its delay is a number too, its period keeps its ratio to the spring's, and for the absolute
/// stability limit a delay that leaves that limit unknown has no value.
/// K is the B of a damper alone where `limit_of` says so: critical_damping() and absolute_stability_damping().
/// Throws Error (invalid_argument) where find_problem() finds one, (did_not_converge) as its parts do.
[[nodiscard]] DesignTargets design_targets(const Device& device, const DesignTargetOptions& options);

}  // namespace zwidth
