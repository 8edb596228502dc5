#pragma once

// The locus of closed-loop poles as one real gain kappa > 0 grows: den(z) + kappa num(z) = 0. On |z| = 1 the gain is
// kappa = -den/num, which must be real: the phase condition
//
//     f(angle) = Im[den conj(num)] / sin(angle) = 0
//
// up to positive factors. With the plant P = z^-L S/D (S = sum of N_k prod_{j != k} D_j, D = prod D_k), c = 1 - a of
// the velocity filter, v = (c/T) delta / (delta + c):
//
//     stiffness      kappa = K, damper B closed:  f = |delta + c|² Im[z^L D conj S] + B (c²/T) |S|²
//     damping        kappa = B, no spring:        f = Im[z^L D (delta + c) conj(delta) conj S]
//     wall           kappa scales K + B v:        f = Im[z^L D (delta + c) conj(K (delta + c) + B (c/T) delta) conj S]
//
// Filters of the wall are further factors of S and D; pairs of their zeros at z = -1 are left out of f, being trivial.
// Nothing is divided, so f has no poles; Im[.] / sin(angle) is the `odd` part of OnCircle.

#include <cstddef>
#include <optional>
#include <vector>

#include "sampling/unit_circle.hpp"
#include "stability/loop/bounded_jet.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

class GainLocus {
 public:
  enum class Gain { stiffness, damping, wall };

  // `stiffness` matters for Gain::wall alone. The plant must outlive the locus.
  GainLocus(const FilteredPlant& plant, Gain gain, double stiffness, VirtualDamper damper);

  // Whether the closed loop has the plant's own poles at kappa = 0: undamped ones are roots of f then.
  [[nodiscard]] bool begins_at_plant_poles() const { return !damper_closed(); }

  // f at an angle in [0, pi], and its first-order Taylor model on an interval of x = |z - 1|², 0 <= begin < end <= 4.
  [[nodiscard]] double value(double angle) const;
  template <typename Scalar>
  [[nodiscard]] BoundedJet<Scalar> model(double begin, double end) const;

  // f over positive factors from the sum of the modal terms, and a bound of its rounding. Where sharp resonances crowd,
  // their product in value() and model() is zero to rounding, while each term of the sum keeps its digits.
  struct TermSum {
    double value = 0.0;
    double noise = 0.0;
    double size = 0.0;          // of what the value is the imaginary part of
    double cancellation = 1.0;  // the terms' magnitudes over that of their sum

    // Rounding of the gain, -1/value where that is real.
    [[nodiscard]] double gain_noise() const { return noise / (size * size); }
  };
  [[nodiscard]] TermSum by_terms(double angle) const;

  // Angles of the plant's oscillating poles.
  [[nodiscard]] std::vector<double> pole_angles() const;

  // |v| of the unit damper at x = |z - 1|²; it grows with x.
  [[nodiscard]] double velocity_size(double chord_squared) const;

  // kappa = -den/num where it is real; infinite or NaN where num vanishes.
  [[nodiscard]] double gain(double angle) const;

  struct Root {
    double angle = 0.0;
    double gain = 0.0;
  };
  // The root of f beside an angle in (0, pi), and its gain, in double-double throughout: where a double next to the root
  // is too far from it. Nothing where f has no change of sign there.
  [[nodiscard]] std::optional<Root> polished_root(double angle) const;

  // Poles outside the unit circle for arbitrarily small kappa > 0 (those of kappa = 0 plus the ones that leave z = 1);
  // undamped pairs apart. `phase_near_zero` is f between angle 0 and its first root.
  [[nodiscard]] int initially_unstable(double phase_near_zero) const;

 private:
  [[nodiscard]] bool damper_closed() const { return gain_ == Gain::stiffness && damping_ > 0.0; }
  template <typename Real>
  OnCircle<Real> extra_factor(const CirclePoint<Real>& point) const;
  template <typename Real>
  Real assemble(const CirclePoint<Real>& point, const OnCircle<Real>& delay) const;
  template <typename Real>
  Real gain_of(const OnCircle<Real>& one_over_plant, const CirclePoint<Real>& point) const;

  const FilteredPlant& plant_;
  Gain gain_;
  double stiffness_;
  double damping_;
  double c_;                       // 1 - a; 1 without a velocity filter
  int integrators_ = 0;            // poles at z = 1 of the plant
  int integrators_kept_ = 0;       // those of den/num
  std::size_t nyquist_pairs_ = 0;  // of the filters' zeros at z = -1
};

}  // namespace zwidth::internal
