#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {

/// Firmware of a motor drive that closes a loop on the position by itself.
enum class DriveFirmware {
  odrive,       ///< ODrive 0.5: a velocity loop within a position loop
  moteus,       ///< position mode: kp and kd
  simplefoc,    ///< MotionControlType::angle: a velocity loop within a position loop
  openffboard,  ///< the end stop of an axis: a spring alone
  vesc,         ///< the position controller: share of the largest current
};

/// A number as the firmware takes it.
struct DriveNumber {
  std::string name;    ///< of the setting: "servo.pid_position.kp"
  double value = 0.0;  ///< in `unit`
  std::string unit;    ///< "N m/turn"; empty: a bare number
};

/// The loop as it closes on a drive, where it is not as the firmware has it by default.
struct DriveLoopOptions {
  std::optional<double> sampling_period = {};  ///< s; > 0
  std::optional<double> delay = {};            ///< s; >= 0; absent: one sampling period
  /// rad/s: encoder.config.bandwidth of an odrive, 2 pi motor_position.sources.N.pll_filter_hz of a moteus; absent: what
  /// makes sensor.tracking_bandwidth, where there is none 1000, 2 pi 400
  std::optional<double> estimator_bandwidth = {};
};

/// A wall in the numbers of a motor drive.
struct DriveGains {
  std::vector<DriveNumber> numbers;  ///< to be set; integral gains and what else would act beside it among them, as 0
  double stiffness = 0.0;            ///< K that these numbers make: less than asked for where the firmware rounds; of a
                                     ///< damper alone the host's
  /// The device with this wall closed on the drive, with the firmware's estimator in place of sensor.tracking_bandwidth. Doubtful,
  /// always: the drive's current loop is not in it, so that its limits bound those of the drive from above.
  Analysis on_drive;
  double sampling_period = 0.0;  ///< s, of that loop
  double delay = 0.0;            ///< s, of that loop
  std::vector<Remark> remarks;   ///< what was taken for granted
};

/// Why the firmware cannot make this device's wall: `member` is a key of the device file.
///
/// Checks: a wall with a stiffness > 0; no filters on its force, no velocity filter but for simplefoc; travel per turn of a
/// linear device; wall.damping > 0 for odrive and simplefoc (their stiffness is a gain of the damping's), 0 for
/// openffboard; a torque per volt or per ampere for simplefoc; actuator.force_limit for vesc and openffboard, which count
/// in shares of it.
///
/// Where the damper runs in a loop of its own (has_damper_loop()) it alone is the drive's: checks a firmware that closes one,
/// a damper > 0 that is faster than the spring, no velocity filter but for simplefoc, travel and torque constant as above.
[[nodiscard]] std::optional<OptionProblem> find_problem(DriveFirmware firmware, const Device& device);

/// Whether the firmware closes a damper beside a force that it is sent: odrive, moteus, simplefoc.
[[nodiscard]] bool closes_damper(DriveFirmware firmware);

/// The damper of a device whose drive closes it ([loop.damper]), as the numbers of the firmware: with B_m as below
///
///     odrive       vel_gain = 2 pi B_m, velocity control; the spring's torque comes as that of the command v, at velocity 0
///     moteus       kp = 0, kd = 2 pi B_m; the spring's torque comes as feedforward torque, at velocity 0
///     simplefoc    PID_velocity.P = B_m/(torque per volt, or torque constant), MotionControlType::velocity; the spring's
///                  torque tau comes as the velocity tau/B_m
///
/// Throws Error (invalid_argument) where find_problem() finds one.
[[nodiscard]] std::vector<DriveNumber> damper_numbers(const Device& device, DriveFirmware firmware);

/// The first member outside its domain. An estimator's bandwidth is for odrive, below 1/(2T), beyond which the firmware
/// refuses it, and for moteus, below 2 pi/(4T); for simplefoc it is that of wall.velocity_filter_hz. None may be given where the device states the damper's loop.
[[nodiscard]] std::optional<OptionProblem> find_problem(const DriveLoopOptions& options, DriveFirmware firmware,
                                                        const Device& device);

/// The device's wall as the numbers that a drive's firmware takes.
///
/// With p the device's travel per turn of the motor (MotorDrive::position_per_turn()) the wall is, at the motor,
///
///     K_m = K (p/2 pi)^2 N m/rad,   B_m = B (p/2 pi)^2 N m s/rad
///
///     odrive       pos_gain = K/B,  vel_gain = 2 pi B_m
///     moteus       kp = 2 pi K_m N m/turn,  kd = 2 pi B_m
///     simplefoc    P_angle.P = K/B,  PID_velocity.P = B_m/(torque per volt, or torque constant)
///     openffboard  esgain = K_m (pi/180) 32767/(25 tau), a whole number of 0 to 255, rounded down
///     vesc         p_pid_kp = K_m (pi/180)/tau per degree,  p_pid_kd_proc = B_m (pi/180)/tau
///
/// tau: the torque of the motor that makes actuator.force_limit; for vesc at the largest current, for openffboard at full
/// power. The loop closes on the drive then, at its rate, not at the device's: odrive 8 kHz, moteus 30 kHz, openffboard and
/// vesc 1 kHz, each the default; simplefoc at the rate of the sketch, taken as the device's.
///
/// An ODrive takes position and velocity from a phase-locked loop of bandwidth w, for each position x measured
///
///     d = x - P - T V,    P += T V + 2 w T d,    V += w² T d
///
/// so that its wall is (K + B v) P(z)/x(z), v the difference low-passed by (1 - a)/(1 - a/z), a = 1 - w T/2. A moteus of
/// firmware from July 2025 on has w = 2 pi pll_filter_hz/2.48 and, in this order,
///
///     d = x - P,    V += w² T d,    P += T (V + 2 w d)
///
/// which is the same with a = 2/(2 + w T). SimpleFOC low-passes its velocity with a = Tf/(Tf + T), Tf = 1/(2 pi
/// wall.velocity_filter_hz). VESC (with an encoder) and OpenFFBoard take the encoder's position as it is, and VESC its
/// difference for the velocity.
/// Of a device whose damper runs in a loop of its own the numbers are damper_numbers(), `on_drive` is the analysis of its
/// two loops, and the drive's estimator is not in it, which is a doubt.
/// Throws Error (invalid_argument) where find_problem() finds one, and as analyze() does.
/// Sources: controller.cpp, encoder.cpp (ODrive 0.5.6), lowpass_filter.cpp (SimpleFOC 2.3), motor_position.h,
/// bldc_servo_control.h, pid.h (moteus db1a7623), FOCMotor and BLDCMotor (SimpleFOC 2.3), Axis.cpp (OpenFFBoard 160af910),
/// foc_math.c, mcpwm_foc.c (VESC b9d287b3).
[[nodiscard]] DriveGains drive_gains(const Device& device, DriveFirmware firmware,
                                     const DriveLoopOptions& options = {});

}  // namespace zwidth
