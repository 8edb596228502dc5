#include "zwidth/stability/quantisation_passivity.hpp"

#include <gtest/gtest.h>

#include "zwidth/stability/analysis.hpp"

namespace zwidth {
namespace {

DeviceParameters rigid() {
  DeviceParameters parameters;
  parameters.bodies.push_back({"body", 0.1, 2.0, 0.0, 0.02});
  parameters.loop.sampling_period = 1e-3;
  parameters.sensor.resolution = 1e-4;
  return parameters;
}

TEST(QuantisationPassivity, IsTheFormula) {
  const auto bound = quantisation_passivity(Device(rigid()));
  ASSERT_TRUE(bound);
  EXPECT_DOUBLE_EQ(bound->friction_stiffness, 400.0);
  EXPECT_DOUBLE_EQ(bound->damping_stiffness, 4000.0);
  EXPECT_DOUBLE_EQ(bound->stiffness, 400.0);
  EXPECT_TRUE(bound->not_met.empty());
  EXPECT_DOUBLE_EQ(analyze(Device(rigid())).quantisation->stiffness, 400.0);
}

TEST(QuantisationPassivity, SaysWhatTheDeviceIsNot) {
  DeviceParameters parameters = rigid();
  parameters.loop.delay = 1e-3;
  parameters.wall.damping = 1.0;
  EXPECT_EQ(quantisation_passivity(Device(parameters))->not_met,
            (std::vector{UnmetAssumption::delay, UnmetAssumption::virtual_damper}));
}

TEST(QuantisationPassivity, NeedsFrictionAndAnEncoder) {
  DeviceParameters parameters = rigid();
  parameters.bodies[0].coulomb = 0.0;
  EXPECT_FALSE(quantisation_passivity(Device(parameters)));
  parameters = rigid();
  parameters.sensor.resolution = 0.0;
  EXPECT_FALSE(quantisation_passivity(Device(parameters)));
}

}  // namespace
}  // namespace zwidth
