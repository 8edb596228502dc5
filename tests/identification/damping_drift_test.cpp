#include <gtest/gtest.h>

#include <vector>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

TEST(DampingDrift, HalfOfItIsLeftToTheRecordsEnd) {
  DeviceParameters device;
  device.bodies = {{.name = "motor", .mass = 0.1, .damping = 2.0}};
  const std::vector<Number> numbers = {
      {.key = "body.motor.damping", .unit = 2.0},
      {.key = "damping_drift", .scale = Number::Scale::any, .unit = 2.0, .prior_deviation = 0.2}};
  EXPECT_DOUBLE_EQ(at_record_end(device, numbers, Eigen::Vector2d(1.0, -0.4)).bodies[0].damping, 1.6);
  EXPECT_DOUBLE_EQ(at_record_end(device, numbers, Eigen::Vector2d(1.0, 0.4)).bodies[0].damping, 2.4);
  EXPECT_EQ(at_record_end(device, numbers, Eigen::Vector2d(1.0, -3.0)).bodies[0].damping, 0.0);
  EXPECT_DOUBLE_EQ(at_record_end(device, {numbers[0]}, Eigen::VectorXd::Ones(1)).bodies[0].damping, 2.0);
}

}  // namespace
}  // namespace zwidth::internal
