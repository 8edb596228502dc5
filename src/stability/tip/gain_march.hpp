#pragma once

// Up to which gain a loop of several outputs is stable, without a gap: the small-gain theorem, step by step.

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <optional>

#include "stability/tip/tip_states.hpp"

namespace zwidth::internal {

// A gain at which poles lie on the unit circle.
struct GainLimit {
  enum class Kind : std::uint8_t {
    crossing,        // stable for all 0 < gain < `gain`
    none_stable,     // unstable at the least gain that is looked at
    unbounded,       // stable at all that are looked at
    not_determined,  // poles come so close to the circle that the steps become too short
  };
  Kind kind = Kind::not_determined;
  double gain = 0.0;             // over the loop's unit
  double angle = 0.0;            // of the pole on the circle, in [0, pi]
  Eigen::VectorXcd motion = {};  // how the outputs move there
};

// With T = P (1 + g P)^-1 of the loop's own poles d_i, |d_i| < 1,
//
//     sup over |z| = 1 of |T(z)|  <=  sum over i of |C r_i| |l_i B| / (1 - |d_i|)  =  N
//
// the loop is stable at all gains less than 1/N away (small-gain theorem). From a least gain upwards each such interval
// begins where the last one ends, to the first gain at which a pole reaches the circle.
[[nodiscard]] GainLimit first_crossing(const GainLoop& loop);

// The same from a gain on at which the loop is stable, upwards and downwards: the first crossing above and below it;
// `unbounded` where there is none, downwards as far as 1e-9 of the gain.
[[nodiscard]] GainLimit crossing_above(const GainLoop& loop, double gain);
[[nodiscard]] GainLimit crossing_below(const GainLoop& loop, double gain);

// The crossing next to a gain, by Newton's method on the size of the pole nearest to the circle and to an angle; nothing
// where it does not converge.
[[nodiscard]] std::optional<GainLimit> polished_crossing(const GainLoop& loop, double gain, double angle);

// The largest pole's size less 1; a pole at z = 1 that the wall neither moves nor sees does not count.
[[nodiscard]] double stability_excess(const GainLoop& loop, double gain);

// The same where the force also turns: of a complex gain, by eigenvalues alone.
[[nodiscard]] double stability_excess_at(const GainLoop& loop, std::complex<double> gain);

// Whether all poles lie inside the circle, but those at z = 1: by eigenvalues alone.
[[nodiscard]] bool is_stable(const GainLoop& loop, double gain);

}  // namespace zwidth::internal
