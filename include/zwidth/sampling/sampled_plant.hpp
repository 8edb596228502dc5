#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth {

/// When the force of the hold reaches the device.
struct Sampling {
  double period = 0.0;  ///< T, s; > 0, finite
  double delay = 0.0;   ///< t_d, s; >= 0, finite
};

/// One term of a sampled plant, polynomials in delta = z - 1 (accurate when all poles crowd at z = 1).
///
///     (n[0] + n[1] delta + ...) / (d[0] + d[1] delta + ... + delta^degree)
struct SampledTerm {
  std::size_t degree = 0;                            ///< how many poles it has
  double numerator[ModalTerm::max_degree + 1] = {};  ///< degree + 1 coefficients
  double denominator[ModalTerm::max_degree] = {};    ///< monic; the leading 1 is not stored
  int mode = 0;                                      ///< as in ModalTerm
  double lag_share = 0.0;                            ///< the part of the lag's term (mode -1) that stems from this one
  double tracking_numerator[3] = {};                 ///< that of the tracking's (mode -2), over its denominator
  int integrators = 0;                               ///< poles at z = 1
  int unstable_poles = 0;                            ///< poles with |z| > 1 (of a transfer function)
  int undamped_pairs = 0;                            ///< pole pairs with |z| = 1, z != 1
  double undamped_angle = 0.0;                       ///< their angle in [0, pi]
  /// What rounding to double left out of each coefficient: where poles crowd (degree > 2); 0 elsewhere
  double numerator_rest[ModalTerm::max_degree + 1] = {};
  double denominator_rest[ModalTerm::max_degree] = {};  ///< by rising powers, without the leading 1
};

/// The plant that the sampled wall sees: Z[H(s) G(s) e^{-t_d s}] = z^-delay_samples sum_k N_k(z - 1) / D_k(z - 1).
struct SampledPlant {
  double period = 0.0;             ///< T, s
  std::size_t delay_samples = 0;   ///< whole samples outside the sum
  std::vector<SampledTerm> terms;  ///< which add up to P(z)
  /// sum_k N_k prod_{j != k} D_j as one polynomial in delta, ascending. Only where the terms nearly cancel (position
  /// sensed across several links, far above the modes), computed in double-double; empty elsewhere.
  std::vector<double> numerator;
  /// P(-1) without the filters, where the terms' numerators nearly vanish at Nyquist; computed in double-double.
  std::optional<double> at_nyquist;
  /// What rounding to double left out of `numerator`; empty where that does not matter.
  std::vector<double> numerator_rest = {};
};

/// The plant as a wall of K + B v(z) sees it, through the wall's filters: F P, since 1 + F (K + B v) P = 0 either way.
///
/// Only filtered_plant() makes one: a limit or a margin with the wall's filters forgotten does not compile.
class FilteredPlant : public SampledPlant {
 public:
  std::vector<FilterSection> filters;  ///< F, in the order in which they run

 private:
  explicit FilteredPlant(SampledPlant plant) : SampledPlant(std::move(plant)) {}
  friend FilteredPlant filtered_plant(SampledPlant plant, const std::vector<WallFilter>& filters);
};

/// Samples exactly behind a zero-order hold with any real delay (modified z-transform; no Padé, no rounding to
/// samples).
///
///     t_d = (l + f) T, 0 <= f < 1:  x[k+1] = F x[k] + G1 u[k-l] + G2 u[k-l-1]
///
/// per modal term, in closed form built on expm1, so that phase and magnitude keep full relative accuracy from
/// 1e-3 rad/s to Nyquist for T from 10 us to 10 ms, modes far above Nyquist included.
/// Throws Error (invalid_argument) for a period or delay outside its domain.
/// Source: eqs. 22, 28 of Díaz & Gil; docs/theory.md, "The loop".
[[nodiscard]] SampledPlant sample(const ModalForm& form, Sampling sampling);

/// modal_form() and sample() of a device with its own period and delay.
[[nodiscard]] SampledPlant sampled_plant(const Device& device);

/// The plant seen through these filters of a wall; none is a statement too: {}.
/// Throws Error (invalid_argument) where a filter has a problem.
[[nodiscard]] FilteredPlant filtered_plant(SampledPlant plant, const std::vector<WallFilter>& filters);

/// The same behind further filters.
[[nodiscard]] FilteredPlant filtered_plant(FilteredPlant plant, const std::vector<WallFilter>& filters);

/// filtered_plant() of sampled_plant() with the device's own wall.filters: what critical_stiffness() needs for a wall.
/// Throws Error (invalid_argument) where the damper runs in a loop of its own: no one plant stands for both.
[[nodiscard]] FilteredPlant filtered_plant(const Device& device);

/// The product of the plant's filters at z = e^{j angle}; 1 without filters.
[[nodiscard]] std::complex<double> filter_response(const FilteredPlant& plant, double angle);

/// One term at z = e^{j angle}, without the whole samples of delay; 0 < angle <= pi.
[[nodiscard]] std::complex<double> response(const SampledTerm& term, double angle);

/// The sampled response at e^{jwT}; 0 < w <= pi/T, rad/s.
[[nodiscard]] std::complex<double> response(const SampledPlant& plant, double frequency);

/// The same through the filters.
[[nodiscard]] std::complex<double> response(const FilteredPlant& plant, double frequency);

}  // namespace zwidth
