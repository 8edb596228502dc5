#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/disk_margin.hpp"
#include "zwidth/stability/force_per_count.hpp"
#include "zwidth/stability/grasp_limit.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/stability/quantisation_passivity.hpp"
#include "zwidth/stability/stiffness_interval.hpp"
#include "zwidth/stability/user_family.hpp"
#include "zwidth/stability/wall_margins.hpp"
#include "zwidth/stability/worst_user.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The device with every link rigid: one mass, damper and spring (user included).
struct RigidApproximation {
  /// Its critical stiffness beside the device's own.
  enum class Error {
    none,    ///< the same within 0.05 %, or both are zero or unbounded
    safe,    ///< lower: stiffness is given away
    unsafe,  ///< higher: a wall designed with it can oscillate
  };
  double mass = 0.0;           ///< kg or kg m^2, of all bodies
  double damping = 0.0;        ///< N s/m or N m s/rad, of all bodies
  double stiffness = 0.0;      ///< to ground
  CriticalStiffness critical;  ///< of the same loop: period, delay, lag, virtual damper
  Error error = Error::none;   ///< none where either is refused
};

/// Eq. 24 of Díaz & Gil: Q = m_m z_n w_n, the stiffness that the resonance peak of a two-body device sits at.
///
/// The mode matters when Q is similar to or *smaller* than the rigid critical stiffness (the paper prints "larger": see
/// docs/theory.md, "The paper's errata"). Q is about the least stiffness of the resonance branch over all delays. An
/// approximation.
struct QCriterion {
  double stiffness = 0.0;  ///< Q
  /// Q <= rigid critical stiffness; absent unless the actuated body is sensed, that stiffness is finite and the
  /// wall has no damper.
  std::optional<bool> mode_matters = {};
  /// Q <= twice that stiffness (6 dB): below, the mode at least shifts the limit of the rigid body; absent as above.
  std::optional<bool> is_similar = {};
};

/// Each body costs a modal form: beyond, the limit over all users would take longer than the rest by far.
inline constexpr std::size_t most_bodies_for_absolute_stability = 20;

/// Beyond, its interval would take seconds.
inline constexpr std::size_t most_bodies_for_absolute_stability_interval = 4;

/// What an analysis computes beside the critical stiffness; what is not asked for costs nothing.
struct AnalysisOptions {
  bool any_user = true;          ///< absolute_stability_limit(), where the device has a body to hold and not too many
  bool critical_damping = true;  ///< HolderLimit::critical_damping of each holder
  bool worst_user = false;       ///< the user who proves that limit; needs any_user
  std::optional<UserRanges> family = {};  ///< worst_of_family() of user_family() of these
  std::size_t draws = 1000;               ///< of the uncertainty, for the interval; 0: no interval
  std::size_t any_user_draws =
      200;                 ///< the same for any_user, of at most most_bodies_for_absolute_stability_interval bodies
  Progress progress = {};  ///< told how far the work is; ends it by throwing
};

/// The critical stiffness, the modes and the margins of a given wall alone: for who prints nothing more.
[[nodiscard]] inline AnalysisOptions limit_and_wall_only() {
  return {.any_user = false, .critical_damping = false, .draws = 0};
}

/// Checks: worst_user only with any_user; the family's ranges finite, >= 0 and not reversed.
[[nodiscard]] std::optional<OptionProblem> find_problem(const AnalysisOptions& options);

/// The same, and what depends on the device: a worst user or a family needs a body to hold, a worst user at most
/// most_bodies_for_absolute_stability bodies.
[[nodiscard]] std::optional<OptionProblem> find_problem(const AnalysisOptions& options, const Device& device);

/// The answer with nobody holding where the file has a user: what HoldingLimits::nobody and StableFor::nobody rest on.
struct AnswerAlone {
  CriticalStiffness critical;                ///< the limit, and every crossover
  std::vector<Mode> modes;                   ///< vibration modes, by rising frequency
  std::optional<Mode> suspended_rigid_body;  ///< where springs tie the device to ground
  std::optional<WallMargins> wall;           ///< absent without wall.stiffness
};

/// What a wall in every direction that a mechanism's tip can move has besides a wall along one.
struct PointWallAnswer {
  double frequency = 0.0;  ///< rad/s, of the oscillation at the critical stiffness; 0 unless finite
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< in which the tip then shakes most; 0 unless finite
  std::optional<PointGraspLimit> any_user = {};  ///< between two bounds; absent where it is not asked for or known
};

/// The whole answer for one device. Where it is refused (trust), no stiffness, margin or interval is held.
struct Analysis {
  CriticalStiffness critical;                         ///< the limit with the file's user, and every crossover
  HoldingLimits limits;                               ///< with nobody, the file's user, any passive user
  std::optional<AnswerAlone> alone;                   ///< with nobody holding; absent without an [operator]
  std::vector<Mode> modes;                            ///< vibration modes, by rising frequency
  std::optional<Mode> suspended_rigid_body;           ///< where springs tie the device to ground
  std::optional<RigidApproximation> rigid;            ///< absent for a transfer function
  std::optional<QCriterion> q_criterion;              ///< only where as_two_mass() applies, no wall filters
  std::optional<WallMargins> wall;                    ///< with the file's user; absent without wall.stiffness
  std::optional<StableFor> wall_stable_for;           ///< of that wall
  std::optional<DiskMargin> disk_margin;              ///< of that wall; absent where it is not stable
  std::optional<ForcePerCount> force_per_count;       ///< of that wall; absent without an encoder resolution too
  std::optional<QuantisationPassivity> quantisation;  ///< absent without Coulomb friction and an encoder resolution
  std::optional<StiffnessInterval> interval;       ///< of the critical stiffness; absent without uncertain parameters
  std::optional<AbsoluteStabilityLimit> any_user;  ///< absent unless asked for, and where there is none (see options)
  std::optional<WorstUser> worst_user;             ///< absent unless asked for, and where any_user is 0 or infinite
  std::optional<UserFamilyAnswer> user_family;     ///< absent unless asked for
  std::optional<PointWallAnswer>
      point_wall;               ///< of is_point_wall() alone: crossovers, intervals and modes are left out
  Trust trust;                  ///< of everything here: the device's, and what the guards found
  std::vector<Remark> remarks;  ///< what was left out, and why; numbers that are probably not in SI units
};

/// Analyses a device: critical stiffness (with the wall's damper closed), modes, rigid approximation, Q, margins,
/// users.
///
/// critical_stiffness() and the wall are checked by a second route; see there.
/// Throws Error (invalid_argument) where find_problem(options, device) finds one, (did_not_converge) as its parts do.
[[nodiscard]] Analysis analyze(const Device& device, const AnalysisOptions& options = {});

/// What of the limits is computed.
struct HoldingOptions {
  bool any_user = true;          ///< as AnalysisOptions::any_user
  bool critical_damping = true;  ///< as AnalysisOptions::critical_damping
  Progress progress = {};        ///< told how far the work is; ends it by throwing
};

/// Analysis::limits alone: with nobody, the file's user and any passive user, the wall's damper and filters closed.
///
/// Where the device is refused its limits are NaN. Throws as analyze() does.
[[nodiscard]] HoldingLimits holding_limits(const Device& device, const HoldingOptions& options = {});

/// Whether the wall given may be relied on, for who must decide by that alone.
enum class WallVerdict {
  stable,    ///< with nobody holding and with the file's user, strictly, and the answer is sound
  unstable,  ///< the answer is sound
  unsure,    ///< doubtful or refused (Analysis::trust says why), whatever was computed
  no_wall    ///< wall.stiffness is missing
};

[[nodiscard]] WallVerdict verdict_on_wall(const Analysis& analysis);  ///< of the wall given

}  // namespace zwidth
