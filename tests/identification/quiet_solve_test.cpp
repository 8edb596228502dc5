#include "identification/initial_fit/quiet_solve.hpp"

#include <ceres/sized_cost_function.h>
#include <glog/logging.h>
#include <gtest/gtest.h>

#include <limits>

namespace zwidth::internal {
namespace {

class NotFinite : public ceres::SizedCostFunction<1, 1> {
 public:
  bool Evaluate(const double* const*, double* residuals, double** jacobians) const override {
    residuals[0] = std::numeric_limits<double>::quiet_NaN();
    if (jacobians && jacobians[0]) jacobians[0][0] = 1.0;
    return true;
  }
};

TEST(QuietSolve, PrintsNothingAndLeavesTheProcessItsLevel) {
  const auto printed = [](const auto& solve) {
    double x = 1.0;
    ceres::Problem problem;
    problem.AddResidualBlock(new NotFinite, nullptr, &x);
    testing::internal::CaptureStderr();
    solve(problem);
    return testing::internal::GetCapturedStderr();
  };
  const int level = FLAGS_minloglevel;
  EXPECT_EQ(printed([](ceres::Problem& problem) {
              EXPECT_FALSE(quiet_solve(ceres::Solver::Options(), problem).IsSolutionUsable());
            }),
            "");
  EXPECT_EQ(FLAGS_minloglevel, level);
  EXPECT_NE(printed([](ceres::Problem& problem) {
              ceres::Solver::Options silent;
              silent.logging_type = ceres::SILENT;
              ceres::Solver::Summary summary;
              ceres::Solve(silent, &problem, &summary);
            }),
            "");  // as Ceres does by itself: else nothing is tested here
}

}  // namespace
}  // namespace zwidth::internal
