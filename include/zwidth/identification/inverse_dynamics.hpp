#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"

namespace zwidth {

/// How forces are computed back from motion.
struct InverseDynamicsOptions {
  std::optional<double> cutoff_hz;        ///< of the zero-phase low-pass; chosen from the record when absent
  std::optional<std::size_t> decimation;  ///< chosen from the cutoff when absent
};

/// mass a + viscous v + coulomb sign(v) + offset = force, fitted to a record of a rigid body that moves both ways.
struct RigidBodyFit {
  ParameterEstimate mass;                  ///< kg or kg m^2
  ParameterEstimate viscous;               ///< N s/m or N m s/rad
  ParameterEstimate coulomb;               ///< N or N m
  ParameterEstimate offset;                ///< N or N m
  ParameterEstimate delay;                 ///< s: how much later than its sample the recorded force acts
  Eigen::Matrix<double, 5, 5> covariance;  ///< of the five, in this order; of the delay 0 where it does not show
  double relative_residual = 0.0;          ///< rms of the residual force / rms of the force, both filtered
  double lowest_hz = 0.0;                  ///< Hz, from where on the force excites the body
  double highest_hz = 0.0;                 ///< Hz, up to where it does, and the body moves more than its noise
  double cutoff_hz = 0.0;                  ///< Hz, of the zero-phase filter that was used
  std::optional<double> first_mode_hz;     ///< where the response of the record turns back: the body is not rigid there
  /// Hz, near which a mode is that shows below it: the apparent mass changes with the square of the frequency.
  std::optional<double> compliant_mode_hz;
  std::size_t decimation = 1;             ///< every so many samples were kept
  std::size_t equations = 0;              ///< samples left after filtering, decimation and removal of rests
  std::vector<double> times{};            ///< s, of the equations
  std::vector<double> forces{};           ///< N or N m, measured and filtered, by equation
  std::vector<double> residual_forces{};  ///< what the fit leaves of them
  std::vector<Remark> remarks;            ///< what is worth knowing beside it
};

/// Mass, viscous and Coulomb friction, offset and delay, in this order.
[[nodiscard]] std::vector<ParameterEstimate> estimates(const RigidBodyFit& fit);

/// Identifies mass, viscous and Coulomb friction and offset of one rigid body from force and position, feedback or not.
///
/// Beside identify() for records that have no free response: a controller made the force, or the motion is slow and ordinary. The
/// equations of one rigid body are linear in its numbers at every instant, so that least squares finds them without a state.
///
///     L[F](t - delay) = mass L[a] + viscous L[v] + coulomb L[sign v] + offset
///
/// a and v are central differences of the position; the zero-phase low-pass L (Butterworth of fourth order, forwards
/// and backwards) acts alike on all terms, so that it biases none; then every `decimation`-th equation is kept. The
/// delay is fitted with the rest: a force that is held after its sample acts half a period late, a drive adds its own.
/// Cutoff, where not given: the frequency below which 99 % of the acceleration's power above the encoder's noise lies,
/// or five times that of half the power (so that the harmonics of Coulomb friction pass) if that is higher; not far
/// above what the force excites, at most a fifth of the first vibration mode's frequency and a tenth of the rate.
/// Decimation: 0.8 times the rate over twice the cutoff. Equations where the body rests (friction then is anything up to
/// coulomb) and near the ends (filter transients) are left out.
/// A mode above the band moves the mass by the frequency's square: the force's second derivative is fitted beside the
/// rest; where it shows, the mass is the one at frequency 0, and where it does not the intervals are widened by its shift.
/// Ordinary least squares; 95 % intervals allow for residuals that vary in size and are correlated in time (Newey and
/// West 1987, bandwidth by Andrews 1991).
/// Requires equally many finite samples, at least 100; `sampling_period` > 0; cutoff below half the rate, decimation
/// >= 1. Throws Error (invalid_argument) otherwise, and where the record does not tell the parameters apart (never
/// moves, never reverses, too short).
/// Source: Gautier, Janot, Vandanjon 2013 (inverse dynamic identification model with least squares, IDIM-LS).
[[nodiscard]] RigidBodyFit identify_rigid_body(std::span<const double> force, std::span<const double> position,
                                               double sampling_period, const InverseDynamicsOptions& options = {},
                                               const Progress& progress = {});

}  // namespace zwidth
