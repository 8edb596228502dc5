#pragma once

#include <string>

#include "zwidth/simulation/simulate.hpp"

namespace zwidth::report {

/// The wall that was rendered: stiffness, damping and its filters, where it begins, on which side it pushes.
[[nodiscard]] std::string simulated_wall_text(const Device& device, const Simulation& result);

/// One sentence: what the loop did, with numbers and units.
[[nodiscard]] std::string verdict_sentence(const Device& device, const Simulation& result);

/// What the linear analysis says of the same wall, and what it leaves out where the two differ.
[[nodiscard]] std::string linear_answer(const Device& device, const Simulation& result);

/// The text of `simulate`: set-up, verdict, numbers, linear answer and remarks; at most 100 columns.
[[nodiscard]] std::string simulation_text(const Device& device, const Simulation& result);

}  // namespace zwidth::report
