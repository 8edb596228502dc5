#include "design/synthesis/wall_check.hpp"

#include <gtest/gtest.h>

#include "lhifam.hpp"

namespace zwidth::internal {
namespace {

// The second route is no formality: what is a little worse than the wall proposed does not pass it.
TEST(WallCheck, RefusesWallsBesideTheOneProposed) {
  DeviceParameters parameters = test::lhifam_parameters();
  const RecommendationOptions options;
  const WallRecommendation answer = recommend_wall(Device(parameters), options);
  ASSERT_TRUE(answer.wall);
  const Wall proposed = answer.wall->wall;
  const auto checked = [&](double spring, double damper) {
    parameters.wall = proposed;
    *parameters.wall.stiffness *= spring;
    parameters.wall.damping *= damper;
    Trust trust;
    check_wall(Device(parameters), options, true, trust);
    return trust.verdict;
  };
  EXPECT_EQ(checked(1.0, 1.0), Trust::Verdict::sound);
  EXPECT_EQ(checked(1.02, 1.0), Trust::Verdict::refused);  // short of phase
  EXPECT_EQ(checked(1.0, 1.02), Trust::Verdict::refused);  // some user destabilises twice the force
  EXPECT_EQ(checked(2.2, 1.0), Trust::Verdict::refused);
  EXPECT_EQ(checked(30.0, 1.0), Trust::Verdict::refused);
}

}  // namespace
}  // namespace zwidth::internal
