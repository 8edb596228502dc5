#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace zwidth::test {

inline std::vector<double> log_spaced(double first, double last, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(first * std::pow(last / first, static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  return values;
}

}  // namespace zwidth::test
