#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

constexpr double smallest_variance = 1e-60;  ///< of a parameter; else 0
constexpr double largest_variance = 1e60;

/// The first impossible thing about the uncertainty of parameters that are otherwise a device's; it must be present.
[[nodiscard]] std::optional<DeviceProblem> find_uncertainty_problem(const DeviceParameters& parameters);

/// The same with the nearest covariance that is one: symmetric, and no combination of the parameters with a negative
/// variance, as rounding may leave where some are known far worse than others.
[[nodiscard]] Uncertainty without_rounding(Uncertainty uncertainty);

/// The uncertain parameter known least: that of the largest variance / value², which is `of_zero` where the value is 0.
struct LeastKnown {
  std::size_t i = 0;
  double share = 0.0;  ///< that ratio; 0 where none is uncertain
};
[[nodiscard]] LeastKnown least_known(const DeviceParameters& parameters, double of_zero);

/// Of the others where parameter i is taken as known: C - c_i c_i' / c_ii. Its variance must not be 0.
[[nodiscard]] Uncertainty given(Uncertainty uncertainty, std::size_t i);

/// Why a device of assumed numbers is doubtful, with the remedy; there must be one at least.
[[nodiscard]] Finding assumed_numbers(const std::vector<std::string>& keys);

}  // namespace zwidth::internal
