// The loop in time behind a drive that tracks the position: grows above the limit and settles below.

#include <gtest/gtest.h>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

LoopVerdict verdict_at(DeviceParameters parameters, double stiffness) {
  parameters.wall.stiffness = stiffness;
  return simulate(Device(std::move(parameters)), {}).verdict;
}

TEST(TrackingSimulation, GrowsAboveTheLimitAndSettlesBelow) {
  test::RandomDevices random(531);
  int compared = 0;
  for (int i = 0; i < 40 && compared < 12; ++i) {
    const std::string_view kind = test::device_kinds[random.index(19)];
    if (kind == "light_damping" || kind == "chain" || kind == "everything") continue;
    DeviceParameters parameters = random.device(kind);
    parameters.sensor.tracking_bandwidth = random.log_uniform(300.0, 1e4);
    const CriticalStiffness critical = critical_stiffness(Device(parameters));
    if (critical.status != StiffnessStatus::finite || critical.stable_intervals.size() != 1) continue;
    EXPECT_EQ(verdict_at(parameters, 0.9 * critical.stiffness), LoopVerdict::settles) << kind << " " << i;
    EXPECT_EQ(verdict_at(parameters, 1.1 * critical.stiffness), LoopVerdict::unstable) << kind << " " << i;
    ++compared;
  }
  EXPECT_GE(compared, 10);
}

TEST(TrackingSimulation, FrictionHoldsWhatWouldGrow) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.tracking_bandwidth = 1000.0;
  const double limit = critical_stiffness(Device(parameters)).stiffness;
  for (Body& body : parameters.bodies) body.coulomb = 50.0;
  EXPECT_NE(verdict_at(parameters, 1.05 * limit), LoopVerdict::unstable);
}

}  // namespace
}  // namespace zwidth
