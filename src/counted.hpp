#pragma once

#include <cstddef>
#include <string_view>

#include "zwidth/finding.hpp"

namespace zwidth::internal {

/// A count as evidence.
[[nodiscard]] inline Evidence counted(std::string_view name, std::size_t count) {
  return {name, static_cast<double>(count)};
}

}  // namespace zwidth::internal
