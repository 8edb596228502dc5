#include "simulation/straight_line.hpp"

#include <cstddef>

namespace zwidth::internal {

StraightLine straight_line(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  StraightLine line;
  for (const double each : values) line.middle += each / n;
  for (std::size_t i = 0; i < values.size(); ++i) {
    line.slope += (static_cast<double>(i) - 0.5 * (n - 1.0)) * (values[i] - line.middle);
  }
  line.slope *= 12.0 / (n * (n * n - 1.0));
  return line;
}

std::vector<double> without_line(std::span<const double> values) {
  const StraightLine line = straight_line(values);
  const double middle = 0.5 * (static_cast<double>(values.size()) - 1.0);
  std::vector<double> residuals(values.begin(), values.end());
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    residuals[i] -= line.middle + line.slope * (static_cast<double>(i) - middle);
  }
  return residuals;
}

}  // namespace zwidth::internal
