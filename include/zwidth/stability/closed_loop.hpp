#pragma once

#include <complex>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"

namespace zwidth {

/// Poles z of the sampled loop 1 + C(z) P(z) = 0, as eigenvalues of its state matrix.
///
/// Given as z - 1 to keep the digits of poles close to z = 1. The route that checks critical_stiffness(): matrix
/// exponential and eigenvalues, no modal form and no frequency response. Cost grows with the cube of the order
/// (device states + whole samples of delay + wall states).
/// wall.stiffness absent counts as 0.
[[nodiscard]] std::vector<std::complex<double>> closed_loop_poles_minus_one(const DiscreteStateSpace& plant,
                                                                            const Wall& wall);

/// Which poles count.
enum class CountedPoles {
  all,               ///< every one
  but_free_position  ///< not the one nearest to z = 1: with K = 0, the position that nothing holds
};

/// Largest |z| - 1 of those poles: negative iff the loop is stable.
[[nodiscard]] double stability_excess(const DiscreteStateSpace& plant, const Wall& wall,
                                      CountedPoles counted = CountedPoles::all);

/// The same of 1 + e^{-j phase} C(z) P(z) = 0 (and of its conjugate), phase in rad: a loop is that far from instability as
/// its phase margin says. Costs eight times as much.
[[nodiscard]] double stability_excess_at_phase(const DiscreteStateSpace& plant, const Wall& wall, double phase);

}  // namespace zwidth
