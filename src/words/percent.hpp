#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace zwidth::internal {

/// A share as words: "0.34 %", "12 %", "130 %", "many times over".
[[nodiscard]] inline std::string percent(double share) {
  if (!std::isfinite(share) || share > 100.0) return "many times over";
  return share < 0.1 ? fmt::format("{:.2g} %", 100.0 * share) : fmt::format("{:.0f} %", 100.0 * share);
}

}  // namespace zwidth::internal
