#include "stability/tip/scan_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr double usual_lowest = 1e-3;
constexpr double least_lowest = 3e-4;
constexpr double below_corners = 0.01;
constexpr double at_rest_below = 1e-9;  // |z - 1| of a pole that is at 1
constexpr double same_angle = 1e-6;     // relative

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

double lowest_angle(const std::vector<std::complex<double>>& poles) {
  double lowest = usual_lowest;
  for (const std::complex<double>& z : poles) {
    const double corner = std::abs(z - 1.0);
    if (corner > at_rest_below) lowest = std::min(lowest, below_corners * corner);
  }
  return std::max(lowest, least_lowest);
}

}  // namespace zwidth::internal
