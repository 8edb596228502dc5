#pragma once

#include <complex>
#include <vector>

namespace zwidth::internal {

// Rising, from `lowest` to pi, rad per sample: `count` evenly in their logarithm, a quarter as many evenly, and those given.
[[nodiscard]] std::vector<double> scan_angles(double lowest, int count, std::vector<double> angles);

// From where grasps of the tip are looked at: 1e-3 rad per sample, or down to 3e-4 where motions with these poles in z have corners
// as low. K loses a share of some 1e-14 over the angle's square.
[[nodiscard]] double lowest_angle(const std::vector<std::complex<double>>& poles);

}  // namespace zwidth::internal
