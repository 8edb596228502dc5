#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "reference/planar_arm.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

// Closed-loop eigenvalues, K to 1e-8 (tests/reference/README.md).
constexpr double relative_tolerance = 1e-8;

// Property: the wall along a normal is a device of coordinates, whose limit is that of closed-loop eigenvalues.
TEST(PlanarArmReference, limit_along_every_normal) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.json");
  int normals = 0;
  for (const nlohmann::json& each : nlohmann::json::parse(file)) {
    if (each["normal"].is_null()) continue;
    ++normals;
    SCOPED_TRACE(each.dump());
    DeviceParameters parameters =
        planar_arm::device({each["pose"][0], each["pose"][1]}, each["normal"][0], each["normal"][1]);
    parameters.loop.delay = each["delay"];
    const CriticalStiffness found = critical_stiffness(Device(parameters));
    EXPECT_TRUE(found.trust.sound());
    EXPECT_NEAR(found.stiffness / each["critical_stiffness"].get<double>(), 1.0, relative_tolerance);
    parameters.wall.damping = each["critical_stiffness_with_damper"][0];
    const CriticalStiffness with_damper = critical_stiffness(Device(parameters));
    EXPECT_TRUE(with_damper.trust.sound());
    EXPECT_NEAR(with_damper.stiffness / each["critical_stiffness_with_damper"][1].get<double>(), 1.0,
                relative_tolerance);
  }
  EXPECT_EQ(normals, 36);
}

}  // namespace
}  // namespace zwidth
