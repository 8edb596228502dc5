#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace zwidth::test {

/// How many random devices a property test tries in all: `in_suite`, or ZWIDTH_PROPERTY_CASES. scripts/campaign tries ten times as
/// many and more.
[[nodiscard]] inline std::size_t property_cases(std::size_t in_suite) {
  if (const char* wish = std::getenv("ZWIDTH_PROPERTY_CASES")) {
    return std::max<std::size_t>(1, std::strtoul(wish, nullptr, 10));
  }
#ifdef NDEBUG
  return in_suite;
#else
  constexpr std::size_t most_in_debug = 2000;
  return std::min(in_suite, most_in_debug);
#endif
}

}  // namespace zwidth::test
