#include "identification/verdict/profile.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <optional>

namespace zwidth::internal {
namespace {

constexpr double rise = 1.92;

/// r = (steep (b - a^2), 0.1 (1 - a)), b - a where it is straight: the cost is within the rise along a valley to a = 1 +- 19.6.
class BentValley final : public LeastSquaresProblem {
 public:
  explicit BentValley(double steep, bool is_bent) : steep_(steep), is_bent_(is_bent) {}
  [[nodiscard]] Eigen::VectorXd lowest() const override {
    return Eigen::VectorXd::Constant(2, -std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& z) const override { return picture(z)->cost; }
  [[nodiscard]] std::optional<Picture> picture(const Eigen::VectorXd& z) const override {
    const double floor = is_bent_ ? z(0) * z(0) : z(0);
    const Eigen::Vector2d left(steep_ * (z(1) - floor), along * (1.0 - z(0)));
    Eigen::Matrix2d slopes;
    slopes << (is_bent_ ? -2.0 * z(0) : -1.0) * steep_, steep_, -along, 0.0;
    return Picture{0.5 * left.squaredNorm(), slopes.transpose() * left, slopes.transpose() * slopes};
  }

 private:
  static constexpr double along = 0.1;
  double steep_;
  bool is_bent_;
};

/// The end of a, from the floor at (1, 1).
ProfileEnd end_of(const BentValley& valley, double direction) {
  const Eigen::Vector2d floor(1.0, 1.0);
  const Minimum minimum{floor, *valley.picture(floor), true};
  return profile_end(
      valley, minimum, [](const Eigen::VectorXd& z) { return z(0); }, 1, direction, rise);
}

TEST(Profile, AStraightValleyEndsWhereTheCostHasRisen) {
  for (const double direction : {-1.0, 1.0}) {
    const ProfileEnd end = end_of(BentValley(1000.0, false), direction);
    EXPECT_EQ(end.last_change, 0.0);
    EXPECT_NEAR(end.value, 1.0 + direction * 19.6, 0.05);
  }
}

TEST(Profile, AnEndThatWasStoppedLiesItsLastStepFurtherOut) {
  for (const double direction : {-1.0, 1.0}) {
    const ProfileEnd end = end_of(BentValley(1000.0, true), direction);
    EXPECT_GT(end.last_change, 0.0);
    EXPECT_GT(direction * (end.z(0) - 1.0), 0.0);
    EXPECT_DOUBLE_EQ(end.value, end.z(0) + direction * end.last_change);
    EXPECT_LT(direction * (end.value - 1.0), 19.6);
  }
}

TEST(Profile, AnEndThatRestsIsTheEnd) {
  int resting = 0;
  for (const double steep : {0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0}) {
    for (const double direction : {-1.0, 1.0}) {
      const ProfileEnd end = end_of(BentValley(steep, true), direction);
      if (end.last_change > 0.0) continue;
      ++resting;
      EXPECT_NEAR(end.value, 1.0 + direction * 19.6, 0.05 * 19.6) << "steep " << steep;
    }
  }
  EXPECT_GT(resting, 0);
}

/// 0.5 a^2, and kinks of a fiftieth: as friction that stops and starts makes them.
class RoughBowl final : public LeastSquaresProblem {
 public:
  [[nodiscard]] Eigen::VectorXd lowest() const override {
    return Eigen::VectorXd::Constant(1, -std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& z) const override {
    return 0.5 * z.squaredNorm() + 0.1 * std::abs(std::sin(20.0 * z(0)));
  }
  [[nodiscard]] std::optional<Picture> picture(const Eigen::VectorXd& z) const override {
    return Picture{*cost(z), z, Eigen::MatrixXd::Identity(1, 1)};
  }
};

TEST(Profile, ARoughCostEndsWhereItHasRisen) {
  const RoughBowl bowl;
  const Eigen::VectorXd floor = Eigen::VectorXd::Zero(1);
  const Minimum minimum{floor, *bowl.picture(floor), true};
  for (const double direction : {-1.0, 1.0}) {
    const ProfileEnd end = profile_end(
        bowl, minimum, [](const Eigen::VectorXd& z) { return z(0); }, 1, direction, rise);
    EXPECT_NEAR(direction * end.value, 1.96, 0.12);
  }
}

}  // namespace
}  // namespace zwidth::internal
