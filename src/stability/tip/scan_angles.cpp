#include "stability/tip/scan_angles.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "stability/tip/tip_response.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr double lowest_angle = 1e-3;
constexpr double least_lowest_angle = 3e-4;
constexpr double below_corners = 0.01;
constexpr double at_rest_below = 1e-9;  // |z - 1| of a pole that is at 1
constexpr double angles_a_decade = 26;  // spaced evenly in their logarithm
constexpr int even_angles = 200;        // spaced evenly: a damper leaves limits that are finite within 0.1 rad alone
constexpr double same_angle = 1e-6;     // relative

double lowest_of(const std::vector<std::complex<double>>& poles) {
  double lowest = lowest_angle;
  for (const std::complex<double>& z : poles) {
    const double corner = std::abs(z - 1.0);
    if (corner > at_rest_below) lowest = std::min(lowest, below_corners * corner);
  }
  return std::max(lowest, least_lowest_angle);
}

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

std::vector<double> grasp_angles(const SampledTip& plant, const GraspDiscs& discs) {
  std::vector<std::complex<double>> poles = TipResponse(plant).poles();
  for (const std::complex<double>& each : discs.held_poles()) poles.push_back(each);
  const double lowest = lowest_of(poles);
  const double count = std::ceil(angles_a_decade * std::log10(pi / lowest));
  std::vector<double> angles = angles_around(poles);
  for (int i = 1; i < even_angles; ++i) angles.push_back(pi * i / even_angles);
  return scan_angles(lowest, static_cast<int>(count), std::move(angles));
}

}  // namespace zwidth::internal
