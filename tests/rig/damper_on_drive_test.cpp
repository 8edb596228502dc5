// A drive that closes the damper by itself, beside the spring of the host: simulated, emulated, and where it cannot.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include "rig/damped_device.hpp"
#include "rig/drive_kinds.hpp"
#include "rig/open_driver.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_devices.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"
#include "rig/simulated_driver.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/simulation/relay_record.hpp"
#include "zwidth/stability/critical_damping.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::rig {
namespace {

/// With a damper of a share of its own limit, at `faster` times the rate, late by a share of its period.
Device with_damper_on_drive(const Device& device, double faster, double share, double lateness) {
  DeviceParameters parameters = device.parameters();
  const double period = parameters.loop.sampling_period / faster;
  const double quarter = 0.25 * period;  // delays on one grid
  parameters.loop.delay = quarter * std::round(parameters.loop.delay / quarter);
  parameters.loop.damper = LoopDamper{period, lateness * period};
  parameters.wall.damping = share * critical_damping(Device(parameters)).damping;
  return Device(parameters);
}

Device belt_with_damper() {
  DeviceParameters parameters = test::belt_device().parameters();
  parameters.loop.damper = LoopDamper{1e-3, 5e-4};
  parameters.wall.damping = 30.0;
  return Device(parameters);
}

template <typename Work>
std::optional<ProblemCode> code_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    if (error.problems().empty() || !error.problems().front().problem) return std::nullopt;
    return error.problems().front().problem->code;
  }
  return std::nullopt;
}

// The simulated drive is another route than the analysis of two rates: it moves the device from instant to instant.
TEST(DamperOnDrive, TheLimitIsMeasuredWhereTwoRatesPredictIt) {
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Device device = with_damper_on_drive(test::bench_device(seed), 4.0 + static_cast<double>(seed % 3), 0.1,
                                               static_cast<double>(seed % 4) * 0.25);
    SimulatedDriver driver{device, 0.0, false};
    LimitOptions options = default_limit(device);
    options.damper_on_drive = true;
    if (options.search.start == 0.0) continue;  // no finite limit
    const RigLimit limit = measure_limit(device, driver, {}, options, {});
    ASSERT_EQ(limit.predicted.status, StiffnessStatus::finite);
    ASSERT_TRUE(limit.measured.stiffness) << explanation(limit.session.stop);
    EXPECT_NEAR(*limit.measured.stiffness / limit.predicted.stiffness, 1.0, 0.02);
    const double one_rate = critical_stiffness(with_one_rate(device)).stiffness;
    if (std::abs(limit.predicted.stiffness / one_rate - 1.0) > 0.05) ++moved;
  }
  EXPECT_GT(moved, 3) << "of those whose limit another schedule would put elsewhere";
}

TEST(DamperOnDrive, AWallIsJudgedByBothLoops) {
  const Device device = belt_with_damper();
  const double limit = critical_stiffness(device).stiffness;
  ASSERT_GT(limit, 1.1 * critical_stiffness(with_one_rate(device)).stiffness);
  for (const double share : {0.95, 1.05}) {
    SCOPED_TRACE(share);
    SimulatedDriver driver{device, 0.0, false};
    WallOptions wall;
    wall.controller = wall_controller(device.parameters().wall);
    wall.controller.stiffness = share * limit;
    wall.impulse = 1.0;
    wall.duration = 20.0;
    wall.damper_on_drive = true;
    const RigWall result = render_wall(device, driver, {}, wall);
    EXPECT_TRUE(result.damper_on_drive);
    EXPECT_EQ(result.controller.damping, 30.0);
    ASSERT_TRUE(result.predicted_stable);
    EXPECT_EQ(*result.predicted_stable, share < 1.0);
    EXPECT_EQ(result.oscillates || result.grows, share > 1.0);
  }
}

TEST(DamperOnDrive, RunsNoOtherDamperThanTheFiles) {
  const Device device = belt_with_damper();
  const auto code = [](const Device& device, bool on_drive, ControllerOptions::Contact contact = {}) {
    WallOptions wall;
    wall.controller = wall_controller(device.parameters().wall);
    wall.controller.contact = contact;
    wall.damper_on_drive = on_drive;
    const auto problem = find_problem(wall, device);
    SimulatedDriver driver{device, 0.0, false};
    EXPECT_EQ(code_of([&] { (void)render_wall(device, driver, {}, wall); }).has_value(), problem.has_value());
    return problem ? std::optional(problem->problem->code) : std::nullopt;
  };
  EXPECT_EQ(code(device, true), std::nullopt);
  EXPECT_EQ(code(device, false), ProblemCode::damper_on_drive_not_asked);
  EXPECT_EQ(code(test::belt_device(), true), ProblemCode::no_damper_loop);
  EXPECT_EQ(code(test::belt_device(), false), std::nullopt);
  EXPECT_EQ(code(device, true, ControllerOptions::Contact::unilateral), ProblemCode::contact_beside_drive);
  DeviceParameters parameters = device.parameters();
  parameters.wall.damping = 0.0;
  EXPECT_EQ(code(Device(parameters), true), ProblemCode::no_damping_for_drive);
  parameters = device.parameters();
  parameters.loop.damper = LoopDamper{0.04, {}};
  EXPECT_EQ(code(Device(parameters), true), ProblemCode::damper_not_faster);
  LimitOptions limit;
  EXPECT_EQ(find_problem(limit, device)->problem->code, ProblemCode::damper_on_drive_not_asked);
  EXPECT_EQ(find_problem(RelayTrialsOptions{}, device)->problem->code, ProblemCode::damper_on_drive_not_asked);
  EXPECT_FALSE(find_problem(RelayTrialsOptions{}, test::belt_device()));
  limit.damper_on_drive = true;
  EXPECT_FALSE(find_problem(limit, device));
}

TEST(DamperOnDrive, DelaysAreThoseOfTheFile) {
  DeviceParameters parameters = belt_with_damper().parameters();
  parameters.loop.delay = 0.012345;
  parameters.loop.damper->delay = std::nullopt;  // that of the loop
  EXPECT_EQ(code_of([&] { DampedDevice(Device(parameters), 0.0); }), std::nullopt);
  parameters.loop.damper->delay = 0.012345 - 0.25e-3;
  EXPECT_EQ(code_of([&] { DampedDevice(Device(parameters), 0.0); }), std::nullopt);
  parameters.loop.damper->delay = 1e-3 / std::sqrt(2.0);
  EXPECT_EQ(code_of([&] { DampedDevice(Device(parameters), 0.0); }), ProblemCode::delays_apart);
}

// A record of a device whose damper may have been closed is none of the device: nothing moves for it.
TEST(DamperOnDrive, IsNotIdentifiedWith) {
  const Device device = belt_with_damper();
  SimulatedDriver driver{device, 0.0, false};
  EXPECT_EQ(code_of([&] { (void)identify_on_rig(device, driver, {}, default_measurement(device), {}); }),
            ProblemCode::damper_closed_while_recorded);
  EXPECT_EQ(driver.measure(), 0.0);
}

// No damper runs beside them: they are those of the device without.
TEST(DamperOnDrive, AResponseIsThatOfTheDeviceWithoutDamper) {
  const Device device = belt_with_damper();
  const Device one_rate = with_one_rate(device);
  MeasureOptions options = default_measurement(one_rate);
  SimulatedDriver driver{device, 0.0, false};
  SimulatedDriver reference{one_rate, 0.0, false};
  const RigMeasurement measured = measure(device, driver, {}, options, {});
  const RigMeasurement expected = measure(one_rate, reference, {}, options, {});
  ASSERT_EQ(measured.recording.channels.size(), 2U);
  EXPECT_EQ(measured.recording.channels[1].samples, expected.recording.channels[1].samples);
}

// The relay takes the place of the spring alone.
TEST(DamperOnDrive, ARelayRunsBesideIt) {
  const Device device = belt_with_damper();
  RelayTrialsOptions trials;
  trials.relay.amplitude = 1.0;
  trials.trials = 1;
  SimulatedDriver driver{device, 0.0, false};
  EXPECT_EQ(code_of([&] { (void)relay_on_rig(device, driver, {}, trials, {}); }),
            ProblemCode::damper_on_drive_not_asked);
  trials.damper_on_drive = true;
  const RigRelay relay = relay_on_rig(device, driver, {}, trials, {});
  ASSERT_TRUE(relay.relay && relay.relay->mean);
  ControllerOptions options;
  options.kind = ControllerOptions::Kind::relay;
  options.amplitude = 1.0;
  SampledController controller(options, device.loop().sampling_period);
  DampedDevice damped(device, 0.0);
  std::vector<double> force;
  std::vector<double> position;
  for (int k = 0; k < 2000; ++k) {
    position.push_back(damped.measure());
    force.push_back(controller.update(position.back()));
    damped.move(force.back());
  }
  const auto reading = analyse_relay_record(force, position, device.loop().sampling_period, {});
  ASSERT_TRUE(reading);
  EXPECT_NEAR(relay.relay->mean->stiffness / reading->stiffness, 1.0, 0.05);
  DeviceParameters bare = device.parameters();
  bare.wall.damping = 0.0;
  EXPECT_GT(relay.relay->mean->stiffness, 2.0 * critical_stiffness(Device(bare)).stiffness);
}

class DamperOfDrive : public testing::TestWithParam<test::DriveKind> {};

// Over the line the device moves as that of the simulated drive, whatever gear, sign and units.
TEST_P(DamperOfDrive, MovesAsTheSimulatedOne) {
  const Device device = belt_with_damper();
  test::PtyEmulator emulator(GetParam().firmware(), device);
  emulator.set_fault(test::PtyEmulator::Fault::no_watchdog);
  const auto driver =
      GetParam().driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  if (!GetParam().closes_damper) {
    EXPECT_EQ(code_of([&] { driver->close_damper(device, 20.0); }), ProblemCode::no_damper_of_its_own);
    EXPECT_TRUE(find_damper_problem(driver->facts().name));
    return;
  }
  EXPECT_FALSE(find_damper_problem(driver->facts().name));
  driver->close_damper(device, 20.0);
  driver->arm();
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().damping() > 0.0; }));
  const double travel = device.parameters().driver->torque_per_force();
  EXPECT_NEAR(emulator.motor().damping() / (30.0 * travel * travel), 1.0, 1e-4);
  DampedDevice expected(device, 0.0);
  double largest = 0.0;
  for (int k = 0; k < 60; ++k) {
    const double force = 4.0 * std::sin(0.3 * k);
    driver->command(force);
    expected.move(force);
    const auto position = driver->measure();
    ASSERT_TRUE(position) << k;
    largest = std::max(largest, std::abs(*position));
    ASSERT_NEAR(*position, expected.measure(), 1e-6) << k;
  }
  EXPECT_GT(largest, 5e-3);
  driver->disarm();
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().force() == 0.0; }));
}

// Drives whose estimator has no such filter: it would be another damper.
TEST_P(DamperOfDrive, TakesTheVelocityFilterOfSimplefocAlone) {
  if (!GetParam().closes_damper) return;
  DeviceParameters parameters = belt_with_damper().parameters();
  parameters.wall.velocity_filter_hz = 100.0;
  const Device device(parameters);
  test::PtyEmulator emulator(GetParam().firmware(), device);
  const auto driver =
      GetParam().driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  const auto code = code_of([&] { driver->close_damper(device, 20.0); });
  if (GetParam().name == "simplefoc") {
    EXPECT_EQ(code, std::nullopt);
  } else {
    EXPECT_EQ(code, ProblemCode::filter_unknown_to_drive);
  }
}

INSTANTIATE_TEST_SUITE_P(Drive, DamperOfDrive, testing::ValuesIn(test::drive_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });
INSTANTIATE_TEST_SUITE_P(Can, DamperOfDrive, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);

}  // namespace
}  // namespace zwidth::rig
