#include "zwidth/model/parameter.hpp"

#include <gtest/gtest.h>

#include "lhifam.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

TEST(Parameter, EveryKeySetsWhatItReads) {
  DeviceParameters parameters = test::lhifam_parameters();
  double value = 1.0;
  for (const std::string& key : parameter_keys(parameters)) {
    set_parameter(parameters, key, value);
    EXPECT_EQ(parameter(parameters, key), value) << key;
    value += 1.0;
  }
  EXPECT_EQ(parameters.bodies[1].damping, 6.0);
  EXPECT_EQ(parameters.links[0].stiffness, 9.0);
}

TEST(Parameter, OneLinkNeedsNoIndex) {
  DeviceParameters parameters = test::lhifam_parameters();
  set_parameter(parameters, "link.stiffness", 5.0);
  EXPECT_EQ(parameter(parameters, "link.0.stiffness"), 5.0);
  parameters.links.push_back(parameters.links[0]);
  EXPECT_EQ(parameter(parameters, "link.stiffness"), std::nullopt);
}

TEST(Parameter, AnInertiaIsAMass) {
  const DeviceParameters parameters = test::lhifam_parameters();
  EXPECT_EQ(parameter(parameters, "body.motor.inertia"), parameters.bodies[0].mass);
  EXPECT_EQ(without_alias("operator.inertia"), "operator.mass");
  EXPECT_EQ(without_alias("loop.delay"), "loop.delay");
}

TEST(Parameter, AbsentValuesAndUnknownKeys) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.wall.stiffness.reset();
  EXPECT_EQ(parameter(parameters, "wall.stiffness"), std::nullopt);
  EXPECT_EQ(parameter(parameters, "body.nobody.mass"), std::nullopt);
  EXPECT_THROW(set_parameter(parameters, "body.nobody.mass", 1.0), Error);
}

}  // namespace
}  // namespace zwidth
