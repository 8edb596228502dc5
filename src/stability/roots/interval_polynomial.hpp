#pragma once

// Polynomials on an interval by their values at Chebyshev points: how far a function is from its interpolant, and
// bounds of the interpolant on the whole interval from its Bernstein coefficients.

#include <array>
#include <cstddef>
#include <limits>

namespace zwidth::internal {

inline constexpr std::size_t interpolation_points = 13;
using InterpolationValues = std::array<double, interpolation_points>;

/// The Chebyshev points of the first kind on [-1, 1], rising.
[[nodiscard]] const InterpolationValues& interpolation_nodes();

/// Bernstein coefficients of the polynomial through values at the interpolation nodes. The first and last are its
/// values at the ends; all its values lie between the least and the greatest.
[[nodiscard]] InterpolationValues bernstein_coefficients(const InterpolationValues& values);

/// How far a function may be from the polynomial through its values: twice the last two Chebyshev coefficients. A
/// function that is analytic inside the ellipse with foci -1 and 1 and semi-axes of sum rho has
/// coefficients that fall as rho^-k; with rho >= 2 those left out are together no larger.
[[nodiscard]] double interpolation_error(const InterpolationValues& values);

/// Rounding of the Bernstein coefficients, in units of the largest of the values: measured, 2e3 units at this degree.
inline constexpr double bernstein_rounding = 4e3 * std::numeric_limits<double>::epsilon();

/// Polynomials through values at the interpolation nodes, all at one place: -1 <= x <= 1.
class InterpolatedAt {
 public:
  explicit InterpolatedAt(double x);
  /// The polynomial through these values.
  [[nodiscard]] double operator()(const InterpolationValues& values) const;

 private:
  InterpolationValues weights_{};  // barycentric; of a node itself 1, of all others 0
  double sum_ = 0.0;
};

struct Halves {
  InterpolationValues left{};
  InterpolationValues right{};
};
/// Bernstein coefficients on the two halves of the interval (de Casteljau).
[[nodiscard]] Halves halves_of(const InterpolationValues& coefficients);

/// The sum of the semi-axes of the ellipse with foci at the ends of the interval through the point position + j depth.
[[nodiscard]] double ellipse_through(double begin, double end, double position, double depth);

}  // namespace zwidth::internal
