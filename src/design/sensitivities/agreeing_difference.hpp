#pragma once

#include <cmath>
#include <complex>
#include <optional>

#include "design/sensitivities/design_parameter.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

inline constexpr double widest_difference = 1e-3;  // of a step's unit
inline constexpr double finer_difference = 0.25;
inline constexpr int most_differences = 7;
inline constexpr double agreeing_differences = 1e-6;   // of the derivative
inline constexpr double agreeing_with_nothing = 1e-8;  // of the value over the step's unit: the derivative is 0

/// How a number is moved to see what depends on it.
struct DifferenceStep {
  double unit = 0.0;  // what a step is a share of
  bool only_grows =
      false;  // steps to the other side tell nothing: the number is 0, or a force arrives just with a sample
};

/// Of a limit K at the frequency w: what is 0 now is measured by what would matter beside K there (K, K/w, K/w²). A delay moves
/// no further than to the next sample of the faster rate.
[[nodiscard]] DifferenceStep difference_step(const DesignParameter& number, const DeviceParameters& parameters,
                                             double stiffness, double frequency);

/// The derivative of `value` at 0 by its step: central differences (one-sided where only growing tells), extrapolated over steps
/// until two agree. Nothing where none do.
template <typename Function>
std::optional<std::complex<double>> agreeing_derivative(const Function& value, DifferenceStep step) {
  const std::complex<double> here = value(0.0);
  const auto difference = [&](double h) {
    if (step.only_grows) return (4.0 * value(h) - value(2.0 * h) - 3.0 * here) / (2.0 * h);
    return (value(h) - value(-h)) / (2.0 * h);
  };
  const auto extrapolated = [&](double h) { return (4.0 * difference(0.5 * h) - difference(h)) / 3.0; };
  double h = widest_difference * step.unit;
  std::complex<double> last = extrapolated(h);
  for (int i = 0; i < most_differences; ++i) {
    h *= finer_difference;
    const std::complex<double> next = extrapolated(h);
    const double apart = std::abs(next - last);
    if (apart <= agreeing_differences * std::abs(next) || apart <= agreeing_with_nothing * std::abs(here) / step.unit) {
      return last;
    }
    last = next;
  }
  return std::nullopt;
}

}  // namespace zwidth::internal
