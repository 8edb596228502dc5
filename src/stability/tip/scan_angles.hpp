#pragma once

#include <vector>

namespace zwidth::internal {

// Rising, from `lowest` to pi, rad per sample: `count` evenly in their logarithm, a quarter as many evenly, and those given.
[[nodiscard]] std::vector<double> scan_angles(double lowest, int count, std::vector<double> angles);

}  // namespace zwidth::internal
