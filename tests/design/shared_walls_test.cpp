// The walls to build on: stable with nobody holding and with the file's user.

#include "zwidth/design/shared_walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

Device knob() {
  DeviceParameters device;
  device.name = "knob";
  device.motion = Motion::rotary;
  device.bodies = {{"knob", 2e-3, 7.1e-3, 0.0, 0.0}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  device.user = {0.0, 6.5e-2, 0.0};
  return Device(device);
}

/// Sensed at the handle, so that a user makes some walls worse, some better.
Device held_lhifam(const User& user) {
  DeviceParameters device = test::handle_sensed(test::lhifam_parameters());
  device.user = user;
  return Device(device);
}

const RegionOptions alone_and_held{.any_user = false, .approximations = false};

double pole_excess(const Device& device, double stiffness, double damping) {
  Wall wall;
  wall.stiffness = stiffness;
  wall.damping = damping;
  return stability_excess(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall);
}

const Device& held_by(Holder holder, const Device& alone, const Device& held) {
  return holder == Holder::nobody ? alone : held;
}

TEST(SharedWalls, OfAUserWhoDampsAreThoseOfNobody) {
  const Device device = knob();
  const WallRegion found = region(device, alone_and_held);
  ASSERT_TRUE(found.nobody && found.shared);
  const WallRegion alone = region(device_without_user(device), alone_and_held);
  EXPECT_FALSE(alone.nobody || alone.shared);
  EXPECT_EQ(found.nobody->region.stiffest->stiffness, alone.region.stiffest->stiffness);
  EXPECT_EQ(found.nobody->region.area, alone.region.area);
  EXPECT_EQ(found.region.critical_stiffness, critical_stiffness(device).stiffness);  // the older keys: with the user
  EXPECT_GT(found.region.critical_stiffness, 135.0);
  EXPECT_EQ(found.shared->critical_stiffness, alone.region.critical_stiffness);
  EXPECT_NEAR(found.shared->critical_stiffness, 14.2, 0.05);
  EXPECT_EQ(found.shared->stiffest->point.stiffness, alone.region.stiffest->stiffness);
  EXPECT_EQ(found.shared->stiffest->holder, Holder::nobody);
  EXPECT_EQ(found.shared->most_damped->point.damping, alone.region.most_damped->damping);
  EXPECT_NEAR(found.shared->area / alone.region.area, 1.0, 1e-9);
}

// Eigenvalues just inside and just outside of the extremes, and a raster, for users whose regions cross that of nobody.
TEST(SharedWalls, AreStableWithBothAndEndWhereOneIsNot) {
  const User users[] = {{0.0, 500.0, 0.0}, {0.0, 500.0, 1e4}, {0.0, 50.0, 1e4}, {1.0, 500.0, 0.0}};
  int crossing = 0;
  for (const User& user : users) {
    SCOPED_TRACE(testing::Message() << user.mass << " " << user.damping << " " << user.stiffness);
    const Device held = held_lhifam(user);
    const Device alone = device_without_user(held);
    const WallRegion found = region(held, alone_and_held);
    ASSERT_EQ(found.status, WallRegion::Status::bounded);
    ASSERT_TRUE(found.nobody && found.shared && found.shared->stiffest && found.shared->most_damped);
    const SharedWalls& shared = *found.shared;
    EXPECT_LE(shared.area, (1.0 + 1e-9) * std::min(found.region.area, found.nobody->region.area));
    EXPECT_LT(shared.area, 0.99 * std::min(found.region.area, found.nobody->region.area));
    const double lesser = std::min(found.region.stiffest->stiffness, found.nobody->region.stiffest->stiffness);
    crossing += shared.stiffest->point.stiffness < 0.999 * lesser;  // where the two boundaries cross

    const BoundaryPoint& stiffest = shared.stiffest->point;
    EXPECT_GT(
        pole_excess(held_by(shared.stiffest->holder, alone, held), (1.0 + 1e-6) * stiffest.stiffness, stiffest.damping),
        0.0);
    for (const Device* each : {&alone, &held}) {
      EXPECT_LT(pole_excess(*each, (1.0 - 1e-5) * stiffest.stiffness, stiffest.damping), 1e-12);
    }
    const WallRaster raster = wall_raster(found, 120);
    const std::vector<std::uint8_t> of_nobody =
        stable_on_grid(*found.nobody->walls, raster.stiffnesses, raster.dampings);
    const std::vector<std::uint8_t> of_user = stable_on_grid(*found.walls, raster.stiffnesses, raster.dampings);
    std::size_t count = 0;
    for (std::size_t i = 0; i < raster.stable.size(); ++i) {
      ASSERT_EQ(raster.stable[i], of_nobody[i] & of_user[i]);
      if (raster.stable[i] == 0) continue;
      ++count;
      EXPECT_LE(raster.stiffnesses[i % 120], stiffest.stiffness);
      EXPECT_LE(raster.dampings[i / 120], shared.most_damped->point.damping);
    }
    const double cell = (raster.stiffnesses[1] - raster.stiffnesses[0]) * (raster.dampings[1] - raster.dampings[0]);
    EXPECT_NEAR(static_cast<double>(count) * cell / shared.area, 1.0, 0.02);
  }
  EXPECT_GE(crossing, 2);
}

}  // namespace
}  // namespace zwidth
