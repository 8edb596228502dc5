#pragma once

#include <cstddef>

#include "sampling/unit_circle.hpp"
#include "stability/loop/bounded_jet.hpp"

namespace zwidth::internal {

// z^L for L whole samples of delay, at an angle in [0, pi].
OnCircle<double> delay_factor(std::size_t delay_samples, double angle);

// The same at x = |z - 1|².
OnCircle<Extended> delay_factor(std::size_t delay_samples, const Extended& x);

// The same on an interval of x = |z - 1|²; Scalar is double or Extended.
template <typename Scalar>
OnCircle<BoundedJet<Scalar>> delay_factor(std::size_t delay_samples, double begin, double end);

}  // namespace zwidth::internal
