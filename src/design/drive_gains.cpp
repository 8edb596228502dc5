#include "zwidth/design/drive_gains.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "require_valid.hpp"

namespace zwidth {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;      // rad
constexpr double degree = std::numbers::pi / 180.0;  // rad
constexpr double endstop_gain = 25.0;                // of OpenFFBoard, counts of torque per degree and esgain
constexpr double endstop_full_scale = 32767.0;       // counts of torque
constexpr double most_endstop = 255.0;               // esgain

MotorDrive drive_of(const Device& device) { return device.parameters().driver.value_or(MotorDrive{}); }

/// At the motor, and what the firmware relates them to.
struct MotorWall {
  double stiffness = 0.0;    // N m/rad
  double damping = 0.0;      // N m s/rad
  double full_torque = 0.0;  // N m
};

MotorWall at_motor(const Device& device) {
  const MotorDrive drive = drive_of(device);
  const Wall& wall = device.parameters().wall;
  const double travel = std::abs(drive.torque_per_force());  // per rad of the motor
  return {*wall.stiffness * travel * travel, wall.damping * travel * travel,
          device.parameters().actuator.force_limit.value_or(0.0) * travel};
}

double period_of(DriveFirmware firmware, const Device& device) {
  switch (firmware) {
    case DriveFirmware::odrive:
      return 1.0 / 8000.0;
    case DriveFirmware::moteus:
      return 1.0 / 30000.0;
    case DriveFirmware::openffboard:
    case DriveFirmware::vesc:
      return 1e-3;
    case DriveFirmware::simplefoc:
      break;
  }
  return device.parameters().loop.sampling_period;
}

std::vector<DriveNumber> numbers_of(DriveFirmware firmware, const Device& device) {
  const MotorDrive drive = drive_of(device);
  const MotorWall wall = at_motor(device);
  const double filter_hz = device.parameters().wall.velocity_filter_hz;
  switch (firmware) {
    case DriveFirmware::odrive: {
      const std::string axis = fmt::format("axis{}.controller.config.", drive.id.value_or(0));
      return {{axis + "pos_gain", wall.stiffness / wall.damping, "turn/s per turn"},
              {axis + "vel_gain", turn * wall.damping, "N m/(turn/s)"},
              {axis + "vel_integrator_gain", 0.0, "N m/turn"}};
    }
    case DriveFirmware::moteus:
      return {{"servo.pid_position.kp", turn * wall.stiffness, "N m/turn"},
              {"servo.pid_position.kd", turn * wall.damping, "N m/(turn/s)"},
              {"servo.pid_position.ki", 0.0, "N m/(turn s)"}};
    case DriveFirmware::simplefoc: {
      const bool by_volts = drive.torque_per_volt.has_value();
      const double per_unit = by_volts ? *drive.torque_per_volt : *drive.torque_constant;
      return {{"P_angle.P", wall.stiffness / wall.damping, "rad/s per rad"},
              {"PID_velocity.P", wall.damping / per_unit, by_volts ? "V/(rad/s)" : "A/(rad/s)"},
              {"PID_velocity.I", 0.0, ""},
              {"PID_velocity.D", 0.0, ""},
              {"PID_velocity.output_ramp", 0.0, ""},
              {"LPF_velocity.Tf", filter_hz > 0.0 ? 1.0 / (turn * filter_hz) : 0.0, "s"}};
    }
    case DriveFirmware::openffboard:
      return {
          {"axis.0.esgain",
           std::floor(wall.stiffness * degree * endstop_full_scale / (endstop_gain * wall.full_torque) * (1.0 + 1e-12)),
           ""}};
    case DriveFirmware::vesc:
      return {{"p_pid_kp", wall.stiffness * degree / wall.full_torque, "1/degree"},
              {"p_pid_ki", 0.0, ""},
              {"p_pid_kd", 0.0, ""},
              {"p_pid_kd_proc", wall.damping * degree / wall.full_torque, "s/degree"},
              {"p_pid_kd_filter", 1.0, ""}};
  }
  return {};
}

std::vector<Remark> remarks_of(DriveFirmware firmware, double period) {
  const auto note = [](std::string what) { return Remark{.what = std::move(what), .consequence = ""}; };
  std::vector<Remark> remarks;
  if (firmware == DriveFirmware::simplefoc) {
    remarks.push_back(note("the loop of the sketch is taken to run at the device's sampling rate: measure it"));
  } else {
    remarks.push_back(
        note(fmt::format("the loop closes on the drive: {:g} Hz, its default, and a delay of one period are taken",
                         std::round(1.0 / period))));
  }
  if (firmware == DriveFirmware::odrive || firmware == DriveFirmware::simplefoc) {
    remarks.push_back(
        note("the velocity limit of the drive bounds the spring: raise it above the first gain times the depth"));
  }
  return remarks;
}

}  // namespace

std::optional<OptionProblem> find_problem(DriveFirmware firmware, const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  const MotorDrive drive = drive_of(device);
  const Wall& wall = parameters.wall;
  const bool cascade = firmware == DriveFirmware::odrive || firmware == DriveFirmware::simplefoc;
  if (!wall.stiffness || !(*wall.stiffness > 0.0)) {
    return OptionProblem{"wall.stiffness", "is missing or 0", "the wall that the drive is to make needs one"};
  }
  if (!wall.filters.empty()) {
    return OptionProblem{"wall.filter", "is given", "the firmware has no such filter: leave it out"};
  }
  if (wall.velocity_filter_hz > 0.0 && firmware != DriveFirmware::simplefoc) {
    return OptionProblem{"wall.velocity_filter_hz", "is given", "the firmware has no such filter: leave it out"};
  }
  if (parameters.motion == Motion::linear && !drive.travel) {
    return OptionProblem{"driver.travel", "is missing", "a linear device needs its travel per turn"};
  }
  if (cascade && !(wall.damping > 0.0)) {
    return OptionProblem{"wall.damping", "is 0", "the firmware's stiffness is a gain of its damping: give one > 0"};
  }
  if (firmware == DriveFirmware::simplefoc && !drive.torque_per_volt && !drive.torque_constant) {
    return OptionProblem{"driver.torque_per_volt", "is missing",
                         "the firmware counts in volts or amperes: give it, or driver.torque_constant"};
  }
  const bool in_shares = firmware == DriveFirmware::openffboard || firmware == DriveFirmware::vesc;
  if (in_shares && !parameters.actuator.force_limit) {
    return OptionProblem{"actuator.force_limit", "is missing",
                         "the firmware counts in shares of its largest torque: give the force that it makes"};
  }
  if (firmware != DriveFirmware::openffboard) return std::nullopt;
  if (wall.damping > 0.0) {
    return OptionProblem{"wall.damping", fmt::format("is {}", wall.damping), "an end stop has none: must be 0"};
  }
  const double gain = numbers_of(firmware, device).front().value;
  if (!(gain >= 1.0 && gain <= most_endstop)) {
    return OptionProblem{"wall.stiffness", fmt::format("is an esgain of {:g}", gain), "must be 1 to 255"};
  }
  return std::nullopt;
}

DriveGains drive_gains(const Device& device, DriveFirmware firmware) {
  internal::require_valid(find_problem(firmware, device));
  DriveGains gains;
  gains.numbers = numbers_of(firmware, device);
  gains.sampling_period = period_of(firmware, device);
  DeviceParameters parameters = device.parameters();
  if (firmware == DriveFirmware::openffboard) {
    const MotorWall wall = at_motor(device);
    parameters.wall.stiffness = *parameters.wall.stiffness * gains.numbers.front().value * endstop_gain *
                                wall.full_torque / (wall.stiffness * degree * endstop_full_scale);
  }
  gains.stiffness = *parameters.wall.stiffness;
  parameters.loop.sampling_period = gains.sampling_period;
  parameters.loop.delay = gains.sampling_period;
  gains.on_drive = analyze(Device(std::move(parameters)));
  gains.on_drive.trust.doubt(
      "the drive's current loop and its estimate of position and velocity are not modelled: the limit on the drive may "
      "be "
      "several times lower; begin with a tenth of it, and raise K by half until it vibrates");
  gains.remarks = remarks_of(firmware, gains.sampling_period);
  return gains;
}

}  // namespace zwidth
