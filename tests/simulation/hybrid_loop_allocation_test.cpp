// The real-time path allocates nothing. This file replaces the global operators of the whole test program.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>

#include "counted_allocations.hpp"
#include "simulation/simulated_devices.hpp"

namespace zwidth {
namespace {

std::size_t allocations_of_steps(HybridLoop& loop) {
  const std::size_t before = allocations;
  for (int k = 0; k < 2000; ++k) loop.step();
  loop.reset();
  for (int k = 0; k < 100; ++k) loop.step();
  return allocations - before;
}

TEST(Allocation, TheCounterCounts) {
  const std::size_t before = allocations;
  int* volatile kept = new int(1);  // else the pair may be optimised away
  delete kept;
  EXPECT_GT(allocations, before);
}

TEST(Allocation, NoneInALinearLoop) {
  HybridLoop loop(Device(test::with_delay(test::lhifam_parameters(), 2.25e-3)),
                  test::starting_at(test::spring_wall(3000.0, 3.0, 100.0), {1e-3, 1e-3}));
  EXPECT_EQ(allocations_of_steps(loop), 0U);
}

TEST(Allocation, NoneWithFilters) {
  HybridLoopOptions options = test::starting_at(test::spring_wall(3000.0, 3.0, 100.0), {1e-3, 1e-3});
  options.controller.filters.assign(max_wall_filters, {.kind = WallFilter::Kind::notch, .frequency_hz = 80.0});
  HybridLoop loop(Device(test::lhifam_parameters()), options);
  EXPECT_EQ(allocations_of_steps(loop), 0U);
}

TEST(Allocation, NoneWithFrictionEncoderUserAndFaults) {
  DeviceParameters device = test::with_friction(test::with_lag(test::lhifam_parameters(), 1e-4), 0.3, 0.6);
  device.sensor.resolution = 3.14e-6;
  device.actuator.force_limit = 5.0;
  HybridLoopOptions options = test::starting_at(test::spring_wall(4000.0, 2.0), {2e-3, 2e-3});
  options.user_force.kind = UserForce::Kind::recorded;
  options.user_force.period = 1.7e-3;
  for (int k = 0; k < 500; ++k) options.user_force.samples.push_back(k % 7 - 3.0);
  options.faults = {0.1, 3e-4, 0.1, 2.5e-3, 5};
  HybridLoop loop(Device(device), options);
  EXPECT_EQ(allocations_of_steps(loop), 0U);
  EXPECT_GT(loop.friction_events(), 0U);
}

TEST(Allocation, NoneWithADamperInALoopOfItsOwn) {
  for (const double damper_period : {1e-4, 4e-3}) {
    DeviceParameters device = test::with_friction(test::with_delay(test::lhifam_parameters(), 2.2e-3), 0.3, 0.6);
    device.loop.damper = LoopDamper{damper_period, 3.3e-3};
    device.sensor.resolution = 3.14e-6;
    device.actuator.force_limit = 5.0;
    HybridLoopOptions options = test::starting_at(test::spring_wall(4000.0, 20.0), {2e-3, 2e-3});
    HybridLoop loop(Device(device), options);
    EXPECT_EQ(allocations_of_steps(loop), 0U);
    EXPECT_GT(loop.friction_events(), 0U);
    options.faults = {0.1, 0.5e-4, 0.1, 1e-3, 5};
    HybridLoop faulty(Device(device), options);
    EXPECT_EQ(allocations_of_steps(faulty), 0U);
  }
}

TEST(Allocation, NoneWithMoreStatesThanAreUnrolled) {
  DeviceParameters chain;
  for (int i = 0; i < 9; ++i) chain.bodies.push_back({"body" + std::to_string(i), 1.0, 1.0, 0.0, i < 3 ? 0.1 : 0.0});
  for (std::size_t i = 0; i < 8; ++i) chain.links.push_back({i, i + 1, 1e4, 1.0});
  chain.loop = {0, 0, 8, 1e-3, 0.0};
  HybridLoop loop(Device(chain), test::starting_at(test::spring_wall(1000.0), std::vector<double>(9, 1e-3)));
  EXPECT_EQ(allocations_of_steps(loop), 0U);
}

}  // namespace
}  // namespace zwidth
