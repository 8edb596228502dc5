#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/inverse_dynamics.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// How a rigid body is identified from forces computed back from motion.
struct RigidBodyOptions {
  InverseDynamicsOptions inverse_dynamics;  ///< of the forces
  std::optional<Motion> motion;             ///< whose units the answer has; absent: stated_motion(), else linear
  std::optional<double> sampling_period;    ///< s, of the loop to judge; absent: the recording's
};

/// Checks cutoff, decimation and sampling period by themselves.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RigidBodyOptions& options);

/// A rigid device identified by inverse dynamics.
struct RigidBodyIdentification {
  std::string source;           ///< the recording's name
  RigidBodyFit fit;             ///< its remarks moved to the ones below
  Device device;                ///< with the covariance of its parameters, the verdict and the reasons
  std::vector<Remark> remarks;  ///< of reading, fit and judgement
  Trust trust;                  ///< of the whole answer
};

/// Identifies one rigid body with dry friction from force and position: identify_rigid_body(), judged.
///
/// Friction that comes out below 0 is taken as 0, and said. The device's delay is what exceeds that of a held force, not
/// below 0, and stands in its covariance. Doubtful where more than a tenth of the force stays unexplained, where the
/// crossover that limits lies outside the excited band or the covariance leaves K_CR open (is_inconclusive()), where the delay
/// does not show, where the body is not rigid, where a force shows that hangs on the position in no linear way (cogging,
/// a spring that stiffens), or where a signal is clipped; refused where more than half stays unexplained. Requires two channels (force, position); throws Error (invalid_argument) where
/// find_problem(options) finds one, where the fitted mass is not above 0, and as identify_rigid_body() does.
[[nodiscard]] RigidBodyIdentification identify_rigid_body(const Recording& recording,
                                                          const RigidBodyOptions& options = {},
                                                          const Progress& progress = {});

}  // namespace zwidth
