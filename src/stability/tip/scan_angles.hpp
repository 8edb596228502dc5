#pragma once

#include <vector>

#include "stability/tip/grasp_discs.hpp"
#include "stability/tip/tip_states.hpp"

namespace zwidth::internal {

// Rising, from `lowest` to pi, rad per sample: `count` evenly in their logarithm, a quarter as many evenly, and those given.
[[nodiscard]] std::vector<double> scan_angles(double lowest, int count, std::vector<double> angles);

// Where grasps of the tip are looked at: also around the poles of the free mechanism and of the one whose tip is held.
//
// From 1e-3 rad per sample, or 3e-4 where the motion has corners as low: K loses a share of some 1e-14 over the angle's square.
[[nodiscard]] std::vector<double> grasp_angles(const SampledTip& plant, const GraspDiscs& discs);

}  // namespace zwidth::internal
