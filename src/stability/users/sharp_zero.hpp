#pragma once

#include <complex>
#include <vector>

#include "model/drive_path.hpp"

namespace zwidth::internal {

/// A zero of Re Y on the axis of frequencies or close beside it, and the discs around it: there the bodies that are
/// damped hardly move. With e = w/w0 - 1 and the depth d of the zero from the axis,
///
///     g = D/(jw) = q_s q_a E/(2 w² q^H Dmp q) = value/measure,   measure = e² + d²; |e|^order where d = 0
///
/// and value is smooth on either side. All from Taylor polynomials at the zero, rounded from a hundred digits, so that
/// the parts that vanish keep their digits however near.
class SharpZero {
 public:
  double frequency = 0.0;  ///< w0 > 0, rad/s
  double depth = 0.0;      ///< relative; 0: exactly on the axis
  int order = 2;           ///< of the discs' pole where the depth is 0; 0 and less: the discs stay finite
  int power = 2;           ///< of Re Y's zero where the depth is 0

  struct Density {
    std::complex<double> value;  // g measure
    double conductance = 0.0;    // Re Y over `of_conductance`
    bool keeps_digits = false;   // nothing cancels in the Taylor polynomials
  };
  [[nodiscard]] double measure(double e) const;
  [[nodiscard]] double of_conductance(double e) const;  ///< e² + d², or |e|^power
  [[nodiscard]] Density density(double e) const;

  using Taylor = std::vector<std::complex<double>>;  // by rising powers of e
  Taylor sensed;                                     ///< without the powers of e that are taken off
  Taylor actuated;
  Taylor determinant;
  Taylor dissipation;
  double of_density = 0.0;      ///< scale of q_s q_a/(2 w² q^H Dmp q)
  double of_dissipation = 0.0;  ///< scale of Re Y
  DrivePath drive;              ///< its frequencies over w0
};

}  // namespace zwidth::internal
