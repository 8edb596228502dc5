#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/design/notch_design.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// What is to be reached, and how far to look.
struct DesignTargetOptions {
  double stiffness = 0.0;                                  ///< the limit to reach, N/m or N m/rad; > 0
  StiffnessGoal goal = StiffnessGoal::critical_stiffness;  ///< which limit is to reach it
  double factor = 1000.0;  ///< each number is followed from p / factor to p * factor; above 1, at most 1e6
  Progress progress = {};  ///< told how far the work is; ends it by throwing
};

/// Checks the stiffness and the factor; of the device: the any-user limit needs a body to hold, and not too many.
[[nodiscard]] std::optional<OptionProblem> find_problem(const DesignTargetOptions& options, const Device& device);

/// What one number of the device file alone would have to be.
struct DesignTarget {
  std::string key;                     ///< as in model/parameter.hpp
  double value_now = 0.0;              ///< p, in the unit of its key
  std::optional<double> value_needed;  ///< the nearest p at which the limit is the target; absent: there is none
  std::string why;                     ///< what limits there, or why no value is enough
};

/// The ways to a stiffness, the cheapest first: least relative change |ln(needed/now)|; numbers that are 0 now after
/// those, in the order of the device file, then those that do not get there.
struct DesignTargets {
  std::optional<double> limit_now;    ///< of the device as it is; infinite where unbounded, absent where refused
  std::vector<DesignTarget> targets;  ///< cheapest relative change first
  Trust trust;                        ///< of the whole answer
  std::vector<Remark> remarks;        ///< what is worth knowing beside it
};

/// For each number p that the limit depends on: the value nearest to today's at which the limit reaches the target.
///
///     K(p) = target,  p alone varied
///
/// p moves by equal factors (a twelfth of a decade; a sixth for the any-user limit) both ways within `factor` and the
/// range that makes a device, from 0 upwards; the first change of sign of K(p) - target is refined until K is the
/// target to 1e-10, or, where the limit jumps across it, to the jump's side that has the target. A scan: a limit that
/// passes the target twice within one step is passed over. For the any-user limit of more than four bodies only those
/// numbers are followed that move it most, by a factor of 10 at most: a remark says how many. Each needed value is confirmed by critical_stiffness(Device)
/// or any_user_limit().
/// Throws Error (invalid_argument) where find_problem() finds one, (did_not_converge) as its parts do.
[[nodiscard]] DesignTargets design_targets(const Device& device, const DesignTargetOptions& options);

}  // namespace zwidth
