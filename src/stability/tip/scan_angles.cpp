#include "stability/tip/scan_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr double same_angle = 1e-6;  // relative

}  // namespace

std::vector<double> scan_angles(double lowest, int count, std::vector<double> angles) {
  for (int i = 0; i <= count; ++i) angles.push_back(lowest * std::pow(pi / lowest, static_cast<double>(i) / count));
  for (int i = 1; i < count / 4; ++i) angles.push_back(pi * 4.0 * i / count);
  std::erase_if(angles, [lowest](double each) { return each < lowest || each > pi * (1.0 - same_angle); });
  angles.push_back(pi);
  std::ranges::sort(angles);
  const auto is_same = [](double a, double b) { return b - a < same_angle * b; };
  angles.erase(std::unique(angles.begin(), angles.end(), is_same), angles.end());
  return angles;
}

}  // namespace zwidth::internal
