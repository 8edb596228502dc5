#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "zwidth/design/absolute_stability_region.hpp"
#include "zwidth/design/stable_walls.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/unmet_assumption.hpp"

namespace zwidth {

/// A formula of the literature for the stiffest wall of a *rigid* device: K = at_zero_damping + slope B.
///
///     colgate_schenkel   b > K T/2 + B (1 - a)/(1 + a), a = exp(-2 pi f_c T), 0 without a filter
///     gil_hulin          K < (b + B) / (T/2 + t_d)
///     diolaiti           K <= b / (T/2 + t_d), B = 0 alone
///
/// b: damping of all bodies to ground; with the device's own [operator] for gil_hulin, without it for the other two,
/// which hold for any passive user.
/// Sources: Colgate & Schenkel 1997 (exact for a rigid device without delay; the filter's factor is their general
/// condition at Nyquist, where it is tightest); Gil et al. 2007, Hulin et al. (small delay, fast sampling, low
/// damping); Diolaiti et al. 2006 (exact for a rigid device whose delay is a whole number of samples).
struct RegionApproximation {
  /// By the names of its authors.
  enum class Formula { colgate_schenkel, gil_hulin, diolaiti };
  Formula formula = Formula::colgate_schenkel;  ///< whose
  bool any_user = false;                        ///< it is about any passive user, not about the device as it is
  double at_zero_damping = 0.0;                 ///< K at B = 0
  double slope = 0.0;                           ///< 1/s
  std::optional<double> largest_damping;        ///< it ends at this B; absent: without end
  std::vector<UnmetAssumption> not_met = {};  ///< what the formula leaves out and the device has; empty where it holds
};

/// What the literature says of a formula.
struct FormulaFacts {
  std::string_view name;       ///< "Colgate & Schenkel"
  std::string_view source;     ///< "Colgate & Schenkel 1997"
  std::string_view equation;   ///< "b > K T/2 + B (1 - a)/(1 + a)"
  std::string_view valid_for;  ///< what it is made for
};
/// What it says and where it holds, for people.
[[nodiscard]] FormulaFacts facts_of(RegionApproximation::Formula formula);

/// Those formulas for the device; none for a transfer function.
/// Throws Error (invalid_argument) for a negative or non-finite filter frequency.
[[nodiscard]] std::vector<RegionApproximation> region_approximations(const Device& device, double velocity_filter_hz);

/// The formula's stiffness at this B; 0 where it allows none.
[[nodiscard]] double stiffness_at(const RegionApproximation& approximation, double damping);

/// How far a formula is off the exact region. Shares are sums over `comparison_rows` equal strips of B; a formula that
/// has no largest B is taken as far as the exact region goes.
struct ApproximationError {
  double at_zero_damping = 0.0;  ///< exact limit at B = 0, the upper end of the interval that starts at K = 0
  std::optional<double> ratio;   ///< formula / exact at B = 0; absent where exact is 0
  bool unsafe = false;           ///< at B = 0 the formula allows walls that are not stable
  // Absent of a formula for B = 0 alone.
  std::optional<double> unsafe_share;  ///< of the walls that the formula allows, those outside the exact region
  std::optional<double> missed_share;  ///< of the exact region, the walls that the formula does not allow
};
inline constexpr int comparison_rows = 400;  ///< stiffnesses at which formula and region are compared

/// Against the stable walls of the device as it is. A formula for B = 0 alone is compared there alone.
[[nodiscard]] ApproximationError approximation_error(const RegionApproximation& approximation, const StableWalls& walls,
                                                     double largest_damping);

/// Against the walls that no passive user destabilises.
[[nodiscard]] ApproximationError approximation_error(const RegionApproximation& approximation,
                                                     const AbsoluteStabilityRegion& region);

}  // namespace zwidth
