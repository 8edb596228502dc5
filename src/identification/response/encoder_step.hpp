#pragma once

#include <span>

namespace zwidth::internal {

/// The encoder's step where the position holds whole steps only; else 0.
[[nodiscard]] double encoder_step(std::span<const double> position);

}  // namespace zwidth::internal
