#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace zwidth::internal {

inline constexpr int most_winding_halvings = 40;

// Change of the phase of f between two angles, halving the step until it is unambiguous.
template <typename Function>
double phase_change(const Function& f, double begin, std::complex<double> at_begin, double end,
                    std::complex<double> at_end, int halvings = most_winding_halvings) {
  const double change = std::arg(at_end / at_begin);
  if (halvings == 0) return change;
  const double middle = 0.5 * (begin + end);
  const std::complex<double> at_middle = f(middle);
  const double first = std::arg(at_middle / at_begin);
  const double second = std::arg(at_end / at_middle);
  if (std::abs(first) + std::abs(second) < std::numbers::pi / 3.0) return first + second;
  return phase_change(f, begin, at_begin, middle, at_middle, halvings - 1) +
         phase_change(f, middle, at_middle, end, at_end, halvings - 1);
}

// Half the turns that f makes over angles 0..pi, in units of pi: the zeros less the poles that it encloses, for a
// function that is real on the real axis. `steps`: at least a few per zero and pole.
template <typename Function>
double winding_number(const Function& f, std::size_t steps) {
  double total = 0.0;
  double begin = 0.0;
  std::complex<double> at_begin = f(0.0);
  for (std::size_t i = 1; i <= steps; ++i) {
    const double end = std::numbers::pi * static_cast<double>(i) / static_cast<double>(steps);
    const std::complex<double> at_end = f(end);
    total += phase_change(f, begin, at_begin, end, at_end);
    begin = end;
    at_begin = at_end;
  }
  return total / std::numbers::pi;
}

}  // namespace zwidth::internal
