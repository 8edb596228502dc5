#include "zwidth/control/sampled_damper.hpp"

#include <gtest/gtest.h>

#include <random>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double damper_period = 1e-3;

ControllerOptions wall() {
  ControllerOptions options;
  options.kind = ControllerOptions::Kind::wall;
  options.stiffness = 2000.0;
  options.damping = 7.0;
  options.velocity_filter_hz = 60.0;
  options.position = 1e-4;
  return options;
}

// At one rate spring and damper are the whole wall.
TEST(SampledDamper, AndTheSpringAreTheWall) {
  SampledController whole(wall(), damper_period);
  SampledController spring(without_damper(wall()), damper_period);
  SampledDamper damper(wall(), damper_period);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> anywhere(-1e-3, 1e-3);
  for (int k = 0; k < 1000; ++k) {
    if (k == 500) {
      whole.reset();
      damper.reset();
    }
    const double position = anywhere(random);
    EXPECT_EQ(sum_of_paths(spring.update(position), damper.update(position), false), whole.update(position));
  }
}

TEST(SampledDamper, OfAUnilateralWallActsInsideAndNeverPulls) {
  ControllerOptions options = wall();
  options.velocity_filter_hz = 0.0;
  options.contact = ControllerOptions::Contact::unilateral;
  ASSERT_TRUE(is_unilateral_wall(options));
  SampledDamper damper(options, damper_period);
  EXPECT_EQ(damper.update(0.0), 0.0);
  EXPECT_DOUBLE_EQ(damper.update(5e-4), -3.5);  // moves in
  EXPECT_DOUBLE_EQ(damper.update(3e-4), 1.4);   // moves out, inside
  EXPECT_EQ(damper.update(1e-4), 0.0);          // on the surface
  EXPECT_EQ(sum_of_paths(-0.4, 1.4, true), 0.0);
  EXPECT_DOUBLE_EQ(sum_of_paths(-2.0, 1.4, true), -0.6);
  EXPECT_DOUBLE_EQ(sum_of_paths(-0.4, 1.4, false), 1.0);
  options.kind = ControllerOptions::Kind::relay;
  EXPECT_FALSE(is_unilateral_wall(options));
}

TEST(SampledDamper, RefusesWhatIsNoDamper) {
  ControllerOptions options = wall();
  EXPECT_THROW(SampledDamper(options, 0.0), Error);
  options.damping = -1.0;
  EXPECT_THROW(SampledDamper(options, damper_period), Error);
}

}  // namespace
}  // namespace zwidth
