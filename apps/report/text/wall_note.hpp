#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysed_device.hpp"

namespace zwidth::report {

/// The verdict on [wall], its share of every limit, and how fast an oscillation decays or grows. Nothing without a wall.
[[nodiscard]] std::optional<std::string> wall_note(const AnalysedDevice& analysed);

/// The warnings about the wall, and the margins of a stable one, one phrase each; empty without a wall.
[[nodiscard]] std::vector<std::string> wall_margin_notes(const Analysis& analysis);

/// words_of(WallStability), "-" where there is no wall.
[[nodiscard]] std::string wall_verdict(const Analysis& analysis);

}  // namespace zwidth::report
