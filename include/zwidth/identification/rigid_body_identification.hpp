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
#include "zwidth/stability/analysis.hpp"
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
/// For records in feedback, or of slow and ordinary motion: their equations have a least-squares fit of one rigid body. A record
/// that was made to identify a device is identify()'s.
///
/// Friction that comes out below 0 is taken as 0, and said. The device's delay is what exceeds that of a held force, not
/// below 0, and stands in its covariance. Sound where the interval of K_CR is within a factor of 1.5 and nothing contradicts.
/// Doubtful where it is wider, or where the data contradict what is taken for true: a column states another quantity or
/// motion, a signal is clipped, the body is not rigid, friction drives it, more than a tenth of the force stays
/// unexplained, the delay does not show, or the crossover that limits lies outside the excited band, of which a rigid body
/// says nothing. Refused where more than half of the force stays unexplained.
///
/// Requires two channels (force, position); throws Error (invalid_argument) where find_problem(options) finds one, where the
/// fitted mass is not above 0 (a sign is turned), and as identify_rigid_body() does.
[[nodiscard]] RigidBodyIdentification identify_rigid_body(const Recording& recording,
                                                          const RigidBodyOptions& options = {},
                                                          const Progress& progress = {});

/// What the fitted body renders with every holder: analyze() of it with its interval, judged as the fit is.
///
/// Throws as analyze() does.
[[nodiscard]] Analysis analyze_fit(const RigidBodyIdentification& identified);

}  // namespace zwidth
