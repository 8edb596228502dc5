#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The stiffest wall along a normal that is stable whoever grasps the tip, in whatever direction he holds it.
struct GraspLimit {
  double stiffness =
      0.0;  ///< N/m; 0 where some grasp destabilises any wall; NaN: not known, a corner lies at some 1e-6 rad a sample
  double frequency = 0.0;  ///< rad/s, where the worst grasp destabilises it; 0: towards w = 0, or a limit of 0
};

/// Whom grasps at a singular pose leave: there a grasp holds fewer directions than at any pose beside it.
enum class GraspedPose {
  beside,  ///< the least over TipMotion::tips_beside: what a pose leaves that no hand keeps to
  alone,   ///< at the pose itself
};

/// The same of a point wall, between two bounds.
struct PointGraspLimit {
  double at_least = 0.0;   ///< N/m; stable with every passive grasp below
  double at_most = 0.0;    ///< N/m; some passive grasp destabilises it there
  double frequency = 0.0;  ///< rad/s, of the lower bound
};

/// The limits along one normal.
struct NormalLimits {
  StiffnessStatus status = StiffnessStatus::refused;  ///< with nobody holding
  double stiffness = 0.0;                             ///< K_CR with nobody holding, N/m; NaN where refused
  double frequency = 0.0;                             ///< rad/s, there; 0 unless finite
  std::optional<GraspLimit> any_grasp = {};           ///< where it is asked for
};

/// What limits_along() computes, besides the limit with nobody holding.
struct NormalLimitsOptions {
  bool any_grasp = true;  ///< the limit over all passive grasps
};

/// The limit over all passive grasps of the tip in 3-D, for a wall along one normal, with its damper closed.
///
/// A grasp is any f_h = -Z(s) s x_tip with Z(jw) + Z(jw)^H >= 0, 3 x 3. With Y = s G_tt and R = Y + Y^H > 0 the plant runs, at
/// one frequency, over the disc
///
///     centre G_sa - jw g_s R^-1 g_a,   radius w |R^-1/2 g_s^H| |R^-1/2 g_a|
///
/// and sampled over the sum of the discs of its aliases, as absolute_stability_limit() for one axis, of which the user is
/// held to the normal: he is one of these. The least over frequency is looked for from w = 1e-3/T, 3e-4/T where the motion has
/// slower corners, to pi/T. What the discs are made of has poles only where R = 0 and where aliases have theirs, which are
/// computed: on intervals that are short where those are near, it is polynomials, which are compared with the discs at the ends of
/// each. Their least, refined on the discs, is not proven to be the least (FindingCode::any_grasp_scanned). The user of `loop` is
/// left out. At a singular pose the limit jumps up; `pose` says which of both. Throws Error (invalid_argument) as
/// point_wall_limit(), and for a normal along which the tip cannot move. Source: docs/theory.md, "Several axes".
[[nodiscard]] GraspLimit any_grasp_limit(const TipMotion& motion, const DeviceParameters& loop,
                                         const Eigen::Vector3d& normal, GraspedPose pose = GraspedPose::beside);

/// The sampled plant along one normal, whoever grasps the tip: at each frequency the disc of any_grasp_limit(), in which neither a
/// wall nor its filters are.
///
/// Beside a singular pose grasps differ with the way there: the discs of all are in the one given.
/// Throws Error (invalid_argument) for a normal along which the tip cannot move.
class GraspedPlant {
 public:
  /// `loop` gives period, delay, lag, and the filters of its wall; its user is left out.
  GraspedPlant(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal);

  /// |p - centre| <= radius, m/N.
  struct Disc {
    std::complex<double> centre;  ///< m/N
    double radius = 0.0;          ///< m/N; infinite where nothing dissipates
  };
  /// 0 < frequency <= pi/T, rad/s.
  [[nodiscard]] Disc at(double frequency) const;

  /// At one frequency a wall g unit + closed with the gain g, the filters that it is behind multiplied in.
  struct Wall {
    std::complex<double> unit;    ///< of the gain's unit
    std::complex<double> closed;  ///< N/m
  };
  /// The least gain g > 0 that some grasp destabilises, in `stiffness`: 1 + (g unit + closed) p = 0 for some p of a disc.
  ///
  /// Found as any_grasp_limit() finds it. `wall` is asked at 0 < frequency <= pi/T, rad/s; it changes as the filters of `loop` do, and
  /// slowly besides.
  [[nodiscard]] GraspLimit least_gain(const std::function<Wall(double frequency)>& wall) const;

  /// Nothing dissipates some motion of the tip: some grasp destabilises any wall.
  [[nodiscard]] bool is_undamped() const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

/// The same for a point wall.
///
/// With the plant's centre C and blocks L_k U_k R_k of the aliases, |U_k| <= 1, a wall K is stable with all of them where K has no
/// real root of the small-gain condition of one block, of LL^H = sum L_k L_k^H / d_k and R^H R = sum d_k R_k^H R_k,
/// d_k = |L_k|/|R_k|: at_least. The frequency's own block alone, the aliases at their centres, is one block, and exact: at_most.
/// Both agree where aliases matter little. Scanned over frequency as the above.
[[nodiscard]] PointGraspLimit any_grasp_limit_of_point(const TipMotion& motion, const DeviceParameters& loop,
                                                       GraspedPose pose = GraspedPose::beside);

/// The limits along many normals at one pose: what is of the pose is computed once.
///
/// The same numbers as normal_wall_limit() and any_grasp_limit(), the latter to 1e-4. The crossover of least stiffness is found
/// by a scan that knows the poles; closed-loop eigenvalues a relative 1e-6 below and above it confirm that limit, and where they
/// do not, normal_wall_limit() answers. Nobody holds: the user of `loop` is left out. Throws as any_grasp_limit().
[[nodiscard]] std::vector<NormalLimits> limits_along(const TipMotion& motion, const DeviceParameters& loop,
                                                     const std::vector<Eigen::Vector3d>& normals,
                                                     const NormalLimitsOptions& options = {});

}  // namespace zwidth
