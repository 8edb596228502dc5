#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace zwidth::internal {

/// The middle value; of an even number the upper of the two in the middle. `values` has at least one.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace zwidth::internal
