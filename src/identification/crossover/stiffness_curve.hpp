#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

#include "identification/crossover/local_estimate.hpp"
#include "identification/crossover/phase_lines.hpp"
#include "zwidth/identification/measured_stiffness.hpp"

namespace zwidth::internal {

/// The dynamic stiffness 1/P of neighbouring lines. Its real part is even in w and its imaginary part odd:
///
///     1/P(w) = a(w^2) + j w b(w^2),   a and b parabolas
///
/// so that a free body, its delay and a resonance are smooth in it.
struct StiffnessCurve {
  using Numbers = Eigen::Matrix<double, 6, 1>;  ///< of a, then of w0 b
  using Covariance = Eigen::Matrix<double, 6, 6>;

  std::size_t first = 0;  ///< line
  std::size_t last = 0;
  double lowest = 0.0;  ///< rad/s, of these lines
  double highest = 0.0;
  Numbers numbers = Numbers::Zero();
  Covariance covariance = Covariance::Zero();

  [[nodiscard]] Estimate real_at(double frequency) const;
  /// Of w0 b, which is 0 where the phase is -180 degrees or 0.
  [[nodiscard]] Estimate imaginary_at(double frequency) const;
  [[nodiscard]] double covariance_at(double frequency) const;  ///< of the two
};

/// The curve around lines[index], of the lines [first, last]: over as many as its misfit allows and as agree with fewer
/// (Lepski's rule). Least squares of P (a + j w b) = 1 by each line's noise (Sanathanan & Koerner 1963), which takes in lines
/// of any noise. `correlation`: see FrequencyResponse. Nothing where too few agree.
[[nodiscard]] std::optional<StiffnessCurve> stiffness_curve(std::span<const PhaseLine> lines, std::size_t index,
                                                            std::size_t first, std::size_t last, double correlation);

/// Where the curve's phase passes -180 degrees, nearest to `frequency`, from the side of `sign` to the other; the intervals are
/// those of the profile: all places w and stiffnesses K within 1.92 of the best log-likelihood of
///
///     b(w) = 0,  a(w) = -K
///
/// Nothing where it does not, or where the curve leaves an end open.
[[nodiscard]] std::optional<MeasuredCrossover> crossing_of(const StiffnessCurve& curve, double frequency, int sign);

}  // namespace zwidth::internal
