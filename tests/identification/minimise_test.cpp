#include "identification/optimiser/minimise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <optional>

namespace zwidth::internal {
namespace {

/// r = (steep (b - a^2), along (1 - a)): a bent valley with its floor at (1, 1).
class Valley final : public LeastSquaresProblem {
 public:
  explicit Valley(double steep = 10.0, double along = 1.0) : steep_(steep), along_(along) {}
  [[nodiscard]] Eigen::VectorXd lowest() const override {
    return Eigen::VectorXd::Constant(2, -std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& z) const override {
    return 0.5 * residuals(z).squaredNorm();
  }
  [[nodiscard]] std::optional<Picture> picture(const Eigen::VectorXd& z) const override {
    const Eigen::Vector2d left = residuals(z);
    Eigen::Matrix2d slopes;
    slopes << -2.0 * steep_ * z(0), steep_, -along_, 0.0;
    return Picture{0.5 * left.squaredNorm(), slopes.transpose() * left, slopes.transpose() * slopes};
  }

 private:
  [[nodiscard]] Eigen::Vector2d residuals(const Eigen::VectorXd& z) const {
    return {steep_ * (z(1) - z(0) * z(0)), along_ * (1.0 - z(0))};
  }

  double steep_;
  double along_;
};

TEST(Minimise, FollowsABentValleyToItsFloor) {
  const auto found = minimise(Valley{}, Eigen::Vector2d(-1.2, 1.0), {.most_steps = 40, .least_gain = 1e-6});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->settled);
  EXPECT_NEAR(found->z(0), 1.0, 1e-2);
  EXPECT_NEAR(found->z(1), 1.0, 2e-2);
}

TEST(Minimise, LeavesHeldElementsWhereTheyAre) {
  const auto found = minimise(Valley{}, Eigen::Vector2d(-1.2, 1.0), {.held = 1});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->settled);
  EXPECT_DOUBLE_EQ(found->z(0), -1.2);
  EXPECT_NEAR(found->z(1), 1.44, 1e-2);
}

TEST(Minimise, EndsAtTheSamePlaceWhateverTheNoiseThatResidualsAreCountedIn) {
  const auto place = [](double scale) {
    MinimiseOptions options{.most_steps = 40, .least_gain = 0.1};
    options.residuals = 2.0;
    const auto found = minimise(Valley(10.0 * scale, scale), Eigen::Vector2d(-1.2, 1.0), options);
    return found ? found->z : Eigen::VectorXd();
  };
  ASSERT_EQ(place(1.0).size(), 2);
  EXPECT_TRUE(place(1000.0).isApprox(place(1.0), 1e-6));
}

TEST(Minimise, StepsThatKeepLittleEndTheSearchUnsettled) {
  const auto found = minimise(Valley(300.0, 1.0), Eigen::Vector2d(-1.2, 1.44), {.most_steps = 400, .least_gain = 1e-3});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->settled);
  EXPECT_FALSE(found->ran_out);
  EXPECT_GT(found->last_step.norm(), 0.0);
}

TEST(Minimise, IsNotSettledWhereItsStepsAreUsedUp) {
  const auto found = minimise(Valley{}, Eigen::Vector2d(-1.2, 1.0), {.most_steps = 1, .least_gain = 1e-6});
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->settled);
  EXPECT_TRUE(found->ran_out);
}

}  // namespace
}  // namespace zwidth::internal
