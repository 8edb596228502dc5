#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/option_problem.hpp"

namespace zwidth {

/// A filter on the force of the wall: one section, of first or second order, of the running controller.
///
/// F(s), w = 2 pi frequency_hz, z = damping_ratio:
///
///     low_pass, order 1    1 / (s/w + 1)
///     low_pass, order 2    1 / ((s/w)² + 2 z s/w + 1)
///     notch                ((s/w)² + 2 z depth s/w + 1) / ((s/w)² + 2 z s/w + 1)      gain `depth` at w
///     lead_lag             (s sqrt(ratio)/w + 1) / (s/(w sqrt(ratio)) + 1)            a lead for ratio > 1; at w of phase
///                                                                                     asin((ratio - 1)/(ratio + 1))
///     biquad               numerator / denominator, descending powers of s
///     digital              numerator / denominator, descending powers of z, run as they stand
///
/// All but digital become F(z) by Tustin's rule prewarped at w (a biquad without frequency_hz: not prewarped):
///
///     s = w / tan(w T/2) (z - 1)/(z + 1)
///
/// so that gain and phase at w are those of F(s). All but biquad and digital have static gain 1: the user feels K.
struct WallFilter {
  /// Which of its numbers it is made of.
  enum class Kind { low_pass, notch, lead_lag, biquad, digital };
  Kind kind = Kind::low_pass;                  ///< of this one
  double frequency_hz = 0.0;                   ///< in (0, 1/(2T)); a biquad may have 0: no prewarping; digital: 0
  int order = 1;                               ///< low_pass: 1 or 2
  double damping_ratio = 0.70710678118654752;  ///< low_pass of order 2 and notch: of the poles; > 0
  double depth = 0.1;                          ///< notch: from 1e-6 to 1
  double ratio = 4.0;                          ///< lead_lag: from 1e-6 to 1e6
  /// biquad and digital: 1 to 3 coefficients, the numerator of no higher degree; stable, static gain > 0.
  std::vector<double> numerator = {};
  std::vector<double> denominator = {};  ///< of a digital one: by rising powers of 1/z

  /// Number by number.
  bool operator==(const WallFilter&) const = default;
};

inline constexpr std::size_t max_wall_filters = 20;  ///< of a wall

/// What makes a filter impossible at that sampling period: the first impossible value, or nothing. The member is its key
/// in [[wall.filter]].
[[nodiscard]] std::optional<OptionProblem> find_problem(const WallFilter& filter, double sampling_period);

}  // namespace zwidth
