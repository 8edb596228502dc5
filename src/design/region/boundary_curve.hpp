#pragma once

#include <cmath>
#include <complex>

#include "stability/loop/bounded_jet.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// A wall (K, B).
struct WallPoint {
  double stiffness = 0.0;
  double damping = 0.0;
};

// The walls that put a pole pair on the unit circle at z = e^{j angle}. With P = z^-L S/D, c = 1 - a of the velocity
// filter and x = |z - 1|², all of them smooth in x up to both ends:
//
//     B |S|² = -(T/c²) (c² + (1 - c) x) Im[z^L D conj S]/sin(angle)
//     K |S|² = -Re[z^L D conj S] + (1/c - 1/2) x Im[z^L D conj S]/sin(angle)
class BoundaryCurve {
 public:
  using Jet = BoundedJet<double>;

  BoundaryCurve(FilteredPlant plant, double velocity_filter_hz);

  // angle in [0, pi]; at 0 and pi the limits. Infinite or NaN where P vanishes.
  [[nodiscard]] WallPoint at(double angle) const;

  // On an interval of x, 0 <= begin < end <= 4: K and B times `seen`, |D|² times the same positive factor.
  struct Model {
    Jet stiffness;
    Jet damping;
    Jet seen;  // |S|²
    Jet open;  // |D|²
  };
  [[nodiscard]] Model model(double begin, double end) const;

  [[nodiscard]] const FilteredPlant& plant() const { return plant_; }
  // The same with one numerator, where there is more than one term.
  [[nodiscard]] const FilteredPlant& added_up() const { return bounded_plant_; }
  [[nodiscard]] double velocity_filter_hz() const { return velocity_filter_hz_; }
  // v(e^{j angle}); |v| grows with the angle, and Re v >= 0.
  [[nodiscard]] std::complex<double> velocity(double angle) const;
  [[nodiscard]] double velocity_at_nyquist() const;
  // K + B v(-1) on the Nyquist line: -1/P(-1); 0 where filters keep every wall away from it.
  [[nodiscard]] double nyquist_stiffness() const;
  // c = 1 - a; 1 without a filter.
  [[nodiscard]] double filter() const { return c_; }

 private:
  template <typename Real>
  struct Numerators {
    Real stiffness;
    Real damping;
  };
  template <typename Real>
  [[nodiscard]] Numerators<Real> numerators(const Real& x, const Real& even, const Real& odd) const;

  FilteredPlant plant_;
  FilteredPlant bounded_plant_;
  double velocity_filter_hz_;
  double c_;
};

inline double least(const BoundaryCurve::Jet& a) { return a.value - std::abs(a.slope) - 0.5 * a.bend; }
inline double greatest(const BoundaryCurve::Jet& a) { return a.value + std::abs(a.slope) + 0.5 * a.bend; }

}  // namespace zwidth::internal
