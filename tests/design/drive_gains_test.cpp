#include "zwidth/design/drive_gains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double pi = std::numbers::pi;

DeviceParameters knob() {
  DeviceParameters parameters;
  parameters.name = "knob";
  parameters.motion = Motion::rotary;
  parameters.bodies.push_back({"knob", 1e-4, 1e-4, 0.0, 0.0});
  parameters.loop.sampling_period = 1e-3;
  parameters.wall.stiffness = 0.5;
  parameters.wall.damping = 0.01;
  return parameters;
}

double number(const DriveGains& gains, const std::string& name) {
  for (const DriveNumber& each : gains.numbers) {
    if (each.name == name) return each.value;
  }
  ADD_FAILURE() << name;
  return 0.0;
}

std::string problem(DriveFirmware firmware, const DeviceParameters& parameters) {
  const auto found = find_problem(firmware, Device(parameters));
  return found ? found->member : "";
}

TEST(DriveGains, OfMoteusCountInTurns) {
  const DriveGains gains = drive_gains(Device(knob()), DriveFirmware::moteus);
  EXPECT_DOUBLE_EQ(number(gains, "servo.pid_position.kp"), 2.0 * pi * 0.5);
  EXPECT_DOUBLE_EQ(number(gains, "servo.pid_position.kd"), 2.0 * pi * 0.01);
  EXPECT_EQ(number(gains, "servo.pid_position.ki"), 0.0);
}

// A controller as the firmware computes it makes the wall's force, whatever the gear, the sign and the travel.
TEST(DriveGains, MakeTheWallThroughAnyGear) {
  DeviceParameters parameters = knob();
  parameters.motion = Motion::linear;
  parameters.actuator.force_limit = 8.0;
  for (const double sign : {1.0, -1.0}) {
    MotorDrive drive;
    drive.travel = 0.04;
    drive.gear = 3.0;
    drive.sign = sign;
    drive.torque_constant = 0.05;
    parameters.driver = drive;
    const Device device(parameters);
    const double x = 0.002;  // m into the wall
    const double v = 0.03;   // m/s
    const double turns = x / drive.position_per_turn();
    const double turns_per_s = v / drive.position_per_turn();
    const double expected = (0.5 * x + 0.01 * v) * drive.torque_per_force();  // N m of the motor

    const DriveGains moteus = drive_gains(device, DriveFirmware::moteus);
    EXPECT_NEAR(number(moteus, "servo.pid_position.kp") * turns + number(moteus, "servo.pid_position.kd") * turns_per_s,
                expected, 1e-12);
    const DriveGains odrive = drive_gains(device, DriveFirmware::odrive);
    EXPECT_NEAR(number(odrive, "axis0.controller.config.vel_gain") *
                    (number(odrive, "axis0.controller.config.pos_gain") * turns + turns_per_s),
                expected, 1e-12);
    const DriveGains simplefoc = drive_gains(device, DriveFirmware::simplefoc);
    EXPECT_NEAR(drive.torque_constant.value() * number(simplefoc, "PID_velocity.P") *
                    (number(simplefoc, "P_angle.P") * 2.0 * pi * turns + 2.0 * pi * turns_per_s),
                expected, 1e-12);
    const double full = 8.0 * std::abs(drive.torque_per_force());
    const DriveGains vesc = drive_gains(device, DriveFirmware::vesc);
    EXPECT_NEAR(full * (number(vesc, "p_pid_kp") * 360.0 * turns + number(vesc, "p_pid_kd_proc") * 360.0 * turns_per_s),
                expected, 1e-12);
  }
}

TEST(DriveGains, OfADamperOfItsOwnAreTheDampersAlone) {
  DeviceParameters parameters = knob();
  parameters.loop.damper = LoopDamper{1e-4, 1e-4};
  parameters.driver = MotorDrive{};
  parameters.driver->torque_constant = 0.05;
  const Device device(parameters);
  const DriveGains odrive = drive_gains(device, DriveFirmware::odrive);
  ASSERT_EQ(odrive.numbers.size(), 2U);
  EXPECT_DOUBLE_EQ(number(odrive, "axis0.controller.config.vel_gain"), 2.0 * pi * 0.01);
  EXPECT_EQ(number(odrive, "axis0.controller.config.vel_integrator_gain"), 0.0);
  EXPECT_EQ(odrive.sampling_period, 1e-4);
  EXPECT_EQ(odrive.delay, 1e-4);
  EXPECT_EQ(odrive.on_drive.critical.stiffness, critical_stiffness(device).stiffness);
  EXPECT_NE(odrive.on_drive.critical.stiffness, critical_stiffness(Device(knob())).stiffness);
  EXPECT_TRUE(std::ranges::any_of(odrive.on_drive.trust.findings, [](const Finding& each) {
    return each.code == FindingCode::damper_estimator_not_modelled;
  }));
  const DriveGains moteus = drive_gains(device, DriveFirmware::moteus);
  EXPECT_EQ(number(moteus, "servo.pid_position.kp"), 0.0);
  EXPECT_DOUBLE_EQ(number(moteus, "servo.pid_position.kd"), 2.0 * pi * 0.01);
  EXPECT_DOUBLE_EQ(number(drive_gains(device, DriveFirmware::simplefoc), "PID_velocity.P"), 0.01 / 0.05);
  const auto code = [](DriveFirmware firmware, const DeviceParameters& of, const DriveLoopOptions& options = {}) {
    auto problem = find_problem(firmware, Device(of));
    if (!problem) problem = find_problem(options, firmware, Device(of));
    return problem ? std::optional(problem->problem->code) : std::nullopt;
  };
  EXPECT_EQ(code(DriveFirmware::odrive, parameters), std::nullopt);
  EXPECT_EQ(code(DriveFirmware::vesc, parameters), ProblemCode::no_damper_of_its_own);
  EXPECT_EQ(code(DriveFirmware::openffboard, parameters), ProblemCode::no_damper_of_its_own);
  EXPECT_EQ(code(DriveFirmware::odrive, parameters, {.sampling_period = 1e-4}), ProblemCode::timing_of_damper_loop);
  EXPECT_EQ(code(DriveFirmware::odrive, parameters, {.estimator_bandwidth = 1e3}), ProblemCode::timing_of_damper_loop);
  parameters.wall.velocity_filter_hz = 100.0;
  EXPECT_EQ(code(DriveFirmware::moteus, parameters), ProblemCode::filter_unknown_to_drive);
  EXPECT_EQ(code(DriveFirmware::simplefoc, parameters), std::nullopt);
  parameters.wall = {.stiffness = 0.5};
  EXPECT_EQ(code(DriveFirmware::odrive, parameters), ProblemCode::no_damping_for_drive);
  parameters = knob();
  parameters.loop.damper = LoopDamper{2e-3, {}};
  EXPECT_EQ(code(DriveFirmware::odrive, parameters), ProblemCode::damper_not_faster);
}

TEST(DriveGains, AnEndStopIsAWholeNumberRoundedDown) {
  DeviceParameters parameters = knob();
  parameters.wall.damping = 0.0;
  parameters.actuator.force_limit = 2.0;
  const DriveGains gains = drive_gains(Device(parameters), DriveFirmware::openffboard);
  EXPECT_EQ(number(gains, "axis.0.esgain"), 5.0);  // 5.72
  EXPECT_NEAR(gains.stiffness, 5.0 * 25.0 / 32767.0 * 2.0 * 180.0 / pi, 1e-12);
  parameters.wall.stiffness = 0.01;
  EXPECT_EQ(problem(DriveFirmware::openffboard, parameters), "wall.stiffness");
}

TEST(DriveGains, TheLimitIsThatOfTheLoopOnTheDrive) {
  DeviceParameters parameters = knob();
  parameters.actuator.force_limit = 2.0;
  const DriveGains gains = drive_gains(Device(parameters), DriveFirmware::vesc);
  parameters.loop.delay = 1e-3;
  EXPECT_EQ(gains.on_drive.critical.stiffness, critical_stiffness(Device(parameters)).stiffness);
  EXPECT_EQ(gains.sampling_period, 1e-3);
  EXPECT_FALSE(gains.on_drive.trust.sound());
  const DriveLoopOptions options{.sampling_period = 1e-4, .delay = 3e-4};
  parameters.loop.sampling_period = 1e-4;
  parameters.loop.delay = 3e-4;
  const DriveGains slow = drive_gains(Device(parameters), DriveFirmware::vesc, options);
  EXPECT_EQ(slow.on_drive.critical.stiffness, critical_stiffness(Device(parameters)).stiffness);
}

/// Energy-like size of the motion after the firmware's own loop has run on the simulated device for a while.
template <typename Firmware>
double swing_after(const DeviceParameters& parameters, double seconds, Firmware firmware) {
  HybridLoopOptions options;
  options.initial_position.assign(1, 0.01);
  HybridLoop loop(Device(parameters), options);
  const auto cycles = static_cast<int>(seconds / parameters.loop.sampling_period);
  double most = 0.0;
  for (int k = 0; k < cycles; ++k) {
    const double position = loop.measure();
    if (k > cycles * 3 / 4) most = std::max(most, std::abs(position));
    loop.move(firmware(position));
  }
  return most;
}

// The limit of the analysis is where the firmware's own equations, run on the device in time, begin to grow.
TEST(DriveGains, TheLimitWithAnOdrivesEstimatorIsWhereItsEquationsBeginToGrow) {
  for (const double bandwidth : {1000.0, 300.0, 3000.0}) {
    DeviceParameters parameters = knob();
    const DriveLoopOptions options{.estimator_bandwidth = bandwidth};
    const double limit = drive_gains(Device(parameters), DriveFirmware::odrive, options).on_drive.critical.stiffness;
    parameters.loop.sampling_period = parameters.loop.delay = 1.0 / 8000.0;
    const auto swing_at = [&](double stiffness) {
      const double period = parameters.loop.sampling_period;
      double estimate = 0.01;  // as encoder.cpp
      double velocity = 0.0;
      return swing_after(parameters, 3.0, [&](double position) {
        estimate += period * velocity;
        const double error = position - estimate;
        estimate += period * 2.0 * bandwidth * error;
        velocity += period * bandwidth * bandwidth * error;
        return -(stiffness * estimate + parameters.wall.damping * velocity);
      });
    };
    EXPECT_LT(swing_at(0.98 * limit), 0.01) << bandwidth;
    EXPECT_GT(swing_at(1.02 * limit), 0.01) << bandwidth;
  }
  const Device device(knob());
  EXPECT_NEAR(drive_gains(device, DriveFirmware::odrive).on_drive.critical.stiffness, 14.0, 1.0);
  EXPECT_EQ(find_problem(DriveLoopOptions{.estimator_bandwidth = 4000.0}, DriveFirmware::odrive, device)->member,
            "estimator_bandwidth");
  EXPECT_EQ(find_problem(DriveLoopOptions{.estimator_bandwidth = 900.0}, DriveFirmware::vesc, device)->member,
            "estimator_bandwidth");
  EXPECT_EQ(find_problem(DriveLoopOptions{.sampling_period = 0.0}, DriveFirmware::vesc, device)->member,
            "sampling_period");
  EXPECT_EQ(find_problem(DriveLoopOptions{.delay = -1.0}, DriveFirmware::vesc, device)->member, "delay");
  EXPECT_FALSE(drive_gains(device, DriveFirmware::odrive).on_drive.trust.sound());
}

// What the host reads positions by is that estimator: it stands in the loop once.
TEST(DriveGains, TheFilesTrackingIsTheEstimators) {
  const auto limit_of = [](DriveFirmware firmware, double tracking, const DriveLoopOptions& options) {
    DeviceParameters parameters = knob();
    parameters.sensor.tracking_bandwidth = tracking;
    parameters.actuator.force_limit = 1.0;
    return drive_gains(Device(parameters), firmware, options).on_drive.critical.stiffness;
  };
  constexpr double corner = 2.48;
  EXPECT_EQ(limit_of(DriveFirmware::odrive, 700.0, {}),
            limit_of(DriveFirmware::odrive, 0.0, {.estimator_bandwidth = 700.0}));
  EXPECT_EQ(limit_of(DriveFirmware::odrive, 1000.0, {}), limit_of(DriveFirmware::odrive, 0.0, {}));
  EXPECT_EQ(limit_of(DriveFirmware::moteus, 700.0, {}),
            limit_of(DriveFirmware::moteus, 0.0, {.estimator_bandwidth = corner * 700.0}));
  EXPECT_EQ(limit_of(DriveFirmware::odrive, 1000.0, {.estimator_bandwidth = 500.0}),
            limit_of(DriveFirmware::odrive, 0.0, {.estimator_bandwidth = 500.0}));
  EXPECT_LT(limit_of(DriveFirmware::vesc, 1000.0, {}), limit_of(DriveFirmware::vesc, 0.0, {}));
  // Where it is too high for the drive's rate, the key is the file's, and so are its numbers.
  for (const auto& [firmware, most] :
       {std::pair(DriveFirmware::odrive, 4000.0), std::pair(DriveFirmware::moteus, 0.25 * 2.0 * pi * 3e4 / corner)}) {
    DeviceParameters parameters = knob();
    parameters.sensor.tracking_bandwidth = 1.01 * most;
    const auto problem = find_problem(DriveLoopOptions{}, firmware, Device(parameters));
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->member, "sensor.tracking_bandwidth");
    EXPECT_NEAR(problem->problem->evidence[0].value, 1.01 * most, 1e-9 * most);
    EXPECT_NEAR(problem->problem->evidence[1].value, most, 1e-9 * most);
    EXPECT_EQ(find_problem(DriveLoopOptions{.estimator_bandwidth = 1e6}, firmware, Device(parameters))->member,
              "estimator_bandwidth");
    parameters.sensor.tracking_bandwidth = 0.99 * most;
    EXPECT_FALSE(find_problem(DriveLoopOptions{}, firmware, Device(parameters)));
  }
}

TEST(DriveGains, TheLimitWithSimplefocsLowPassIsWhereItsEquationsBeginToGrow) {
  DeviceParameters parameters = knob();
  parameters.wall.velocity_filter_hz = 1.0 / (2.0 * pi * 0.005);  // its default, Tf = 5 ms
  parameters.driver.emplace().torque_per_volt = 0.02;
  const DriveGains gains = drive_gains(Device(parameters), DriveFirmware::simplefoc);
  EXPECT_NEAR(number(gains, "LPF_velocity.Tf"), 0.005, 1e-12);
  parameters.loop.delay = parameters.loop.sampling_period;
  const auto swing_at = [&](double stiffness) {
    const double period = parameters.loop.sampling_period;
    double last = 0.01;
    double velocity = 0.0;
    return swing_after(parameters, 6.0, [&](double position) {
      const double pole = 0.005 / (0.005 + period);  // as lowpass_filter.cpp
      velocity = pole * velocity + (1.0 - pole) * (position - last) / period;
      last = position;
      return -(stiffness * position + parameters.wall.damping * velocity);
    });
  };
  EXPECT_LT(swing_at(0.98 * gains.on_drive.critical.stiffness), 0.01);
  EXPECT_GT(swing_at(1.02 * gains.on_drive.critical.stiffness), 0.01);
}

// Its loop predicts with the velocity as corrected, so that the bound is neither an ODrive's nor the bare encoder's.
TEST(DriveGains, TheLimitWithMoteusEstimatorIsWhereItsEquationsBeginToGrow) {
  for (const double corner_hz : {400.0, 50.0, 2000.0}) {
    DeviceParameters parameters = knob();
    const DriveLoopOptions options{.estimator_bandwidth = 2.0 * pi * corner_hz};
    const double limit = drive_gains(Device(parameters), DriveFirmware::moteus, options).on_drive.critical.stiffness;
    parameters.loop.sampling_period = parameters.loop.delay = 1.0 / 30000.0;
    const auto swing_at = [&](double stiffness) {
      const double period = parameters.loop.sampling_period;
      const double natural = 2.0 * pi * corner_hz / 2.48;  // as motor_position.h
      double estimate = 0.01;
      double integral = 0.0;
      return swing_after(parameters, 10.0, [&](double position) {
        const double error = position - estimate;
        integral += period * natural * natural * error;
        estimate += period * (integral + 2.0 * natural * error);
        return -(stiffness * estimate + parameters.wall.damping * integral);
      });
    };
    EXPECT_LT(swing_at(0.98 * limit), 0.01) << corner_hz;
    EXPECT_GT(swing_at(1.02 * limit), 0.01) << corner_hz;
  }
  const Device device(knob());
  EXPECT_EQ(
      drive_gains(device, DriveFirmware::moteus).on_drive.critical.stiffness,
      drive_gains(device, DriveFirmware::moteus, {.estimator_bandwidth = 800.0 * pi}).on_drive.critical.stiffness);
  EXPECT_EQ(find_problem(DriveLoopOptions{.estimator_bandwidth = 15000.0 * pi}, DriveFirmware::moteus, device)->member,
            "estimator_bandwidth");
}

TEST(DriveGains, TheLimitOfAVescIsWhereItsEquationsBeginToGrow) {
  DeviceParameters parameters = knob();
  parameters.actuator.force_limit = 1e6;  // out of reach: the knob swings by 10 mrad
  const DriveGains gains = drive_gains(Device(parameters), DriveFirmware::vesc);
  parameters.loop.delay = parameters.loop.sampling_period;
  const double to_torque = 1e6 * 180.0 / pi;  // of a share per degree
  const auto swing_at = [&](double stiffness) {
    const double period = parameters.loop.sampling_period;
    const double constant = number(gains, "p_pid_kd_filter");
    double last = 0.01;
    double filtered = 0.0;
    return swing_after(parameters, 6.0, [&](double position) {  // as foc_math.c
      const double rate = -number(gains, "p_pid_kd_proc") * (position - last) / period;
      filtered -= constant * (filtered - rate);
      last = position;
      return to_torque * (-number(gains, "p_pid_kp") * stiffness / gains.stiffness * position + filtered);
    });
  };
  EXPECT_LT(swing_at(0.98 * gains.on_drive.critical.stiffness), 0.01);
  EXPECT_GT(swing_at(1.02 * gains.on_drive.critical.stiffness), 0.01);
}

// 30 unless it is set: a damping through two filters that no number of the wall's accounts for.
TEST(DriveGains, AnEndStopActsAlone) {
  DeviceParameters parameters = knob();
  parameters.wall.damping = 0.0;
  parameters.actuator.force_limit = 2.0;
  EXPECT_EQ(number(drive_gains(Device(parameters), DriveFirmware::openffboard), "axis.0.axisdamper"), 0.0);
}

TEST(DriveGains, WhatIsMissingIsNamed) {
  DeviceParameters parameters = knob();
  EXPECT_EQ(problem(DriveFirmware::simplefoc, parameters), "driver.torque_per_volt");
  EXPECT_EQ(problem(DriveFirmware::vesc, parameters), "actuator.force_limit");
  EXPECT_EQ(problem(DriveFirmware::openffboard, parameters), "actuator.force_limit");
  parameters.wall.velocity_filter_hz = 50.0;
  EXPECT_EQ(problem(DriveFirmware::moteus, parameters), "wall.velocity_filter_hz");
  parameters.wall.velocity_filter_hz = 0.0;
  parameters.wall.damping = 0.0;
  EXPECT_EQ(problem(DriveFirmware::odrive, parameters), "wall.damping");
  EXPECT_EQ(problem(DriveFirmware::moteus, parameters), "");
  parameters.motion = Motion::linear;
  EXPECT_EQ(problem(DriveFirmware::moteus, parameters), "driver.travel");
  parameters.wall.stiffness.reset();
  EXPECT_EQ(problem(DriveFirmware::moteus, parameters), "wall.stiffness");
  EXPECT_THROW((void)drive_gains(Device(parameters), DriveFirmware::moteus), Error);
}

}  // namespace
}  // namespace zwidth
