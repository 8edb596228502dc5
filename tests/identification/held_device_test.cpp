#include "identification/held_device.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "lhifam.hpp"

namespace zwidth {
namespace {

// 1.2 times the mass and four times the damping is a hand's too: it had to be 1.3 and 2 times.
TEST(HeldDevice, AHandIsToldByMassAndDampingTogether) {
  const auto doubt_of = [](double mass, double damping) {
    std::vector<ParameterEstimate> estimates(2);
    estimates[0] = {"body.handle.mass", mass, true, 0.01, mass - 0.02, mass + 0.02};
    estimates[1] = {"body.handle.damping", damping, true, 0.01, damping - 0.02, damping + 0.02};
    DeviceParameters structure = test::lhifam_parameters();
    structure.bodies[1].mass = 2.0;
    structure.bodies[1].damping = 2.0;
    return internal::doubt_of_hand(Device(structure), estimates, {}).has_value();
  };
  EXPECT_TRUE(doubt_of(2.4, 8.0));
  EXPECT_TRUE(doubt_of(5.0, 3.5));
  EXPECT_FALSE(doubt_of(2.0, 2.0));
  EXPECT_FALSE(doubt_of(2.1, 8.0));
  EXPECT_FALSE(doubt_of(2.4, 2.4));
}

}  // namespace
}  // namespace zwidth
