#include "workspace/direction_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace zwidth::internal {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

// A crossover appears at 39 degrees, between two of twelve directions, and is gone at 44: a limit that falls and jumps.
double in_plane(const Eigen::Vector3d& normal) {
  double angle = std::atan2(normal.y(), normal.x()) / degree;
  if (angle < 0.0) angle += 180.0;
  if (angle < 39.0) return 130.0 - angle / 10.0;
  if (angle < 44.0) return 60.0 - 8.0 * (angle - 39.0);
  return 668.0 + angle;
}

TEST(LeastDirection, IsFoundBesideAJumpInThePlane) {
  const Eigen::MatrixXd moved = Eigen::MatrixXd::Identity(3, 2);
  const std::vector<Eigen::Vector3d> tried = spread_directions(moved, usual_directions(2));
  std::vector<double> values;
  for (const Eigen::Vector3d& each : tried) values.push_back(in_plane(each));
  EXPECT_LT(least_direction(tried, values, moved, in_plane, true).value, 30.0);
}

// A cap of five degrees around a direction that none of the spread is near.
TEST(LeastDirection, IsFoundBesideAJumpInSpace) {
  const Eigen::MatrixXd moved = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d edge = Eigen::Vector3d(1.0, 0.4, 0.7).normalized();
  const auto limit = [&](const Eigen::Vector3d& normal) {
    const double off = std::acos(std::min(std::abs(edge.dot(normal)), 1.0)) / degree;
    const bool is_beyond = normal.x() * normal.z() > 0.0;
    return off < 12.0 ? 20.0 + off : is_beyond ? 900.0 : 100.0;
  };
  const std::vector<Eigen::Vector3d> tried = spread_directions(moved, usual_directions(3));
  std::vector<double> values;
  for (const Eigen::Vector3d& each : tried) values.push_back(limit(each));
  EXPECT_LT(least_direction(tried, values, moved, limit, true).value, 30.0);
}

}  // namespace
}  // namespace zwidth::internal
