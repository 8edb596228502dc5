#pragma once

#include <limits>

namespace zwidth::internal {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace zwidth::internal
