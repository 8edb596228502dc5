#include "rig/simplefoc_driver.hpp"

#include <cmath>
#include <numbers>

#include "rig/real_time.hpp"
#include "rig/simplefoc_protocol.hpp"
#include "zwidth/error.hpp"

namespace zwidth::rig {
namespace {

constexpr int default_baud = 115200;
constexpr int idle_frames = 2;
constexpr double silences[] = {0.1, 0.2, 0.5};  // s, in which a sketch's own timeout may disable the motor
constexpr int tries_while_booting = 8;          // many boards start anew when their port is opened: 2 s
constexpr std::string_view machine_readable = "@3\n";
constexpr std::string_view six_decimals = "#6\n";
constexpr std::string_view get_angle = "MG6";
constexpr std::string_view angle_echo = "MG";
constexpr std::string_view motion_control = "C";  // its echo, too

// "MMG6", "MMG-12.345678", "M-1.23457e-05" and its echo "M-0.000012", with their ends.
constexpr double bytes_per_cycle = 5 + 15 + 14 + 12;
constexpr double force_bytes = 14;

double constant(const std::optional<double>& given, std::string_view key, std::string_view unit) {
  if (given) return *given;
  throw Error(ErrorCode::invalid_argument,
              fmt::format("driver.{}: is missing: the sketch controls torque in {}; must be given", key, unit));
}

/// Either may do; which one the sketch needs it tells on the line alone.
const std::string& checked_port(const SerialLink& link) {
  if (!link.drive.torque_per_volt) (void)constant(link.drive.torque_constant, "torque_constant", "amperes");
  return link.port;
}

}  // namespace

SimplefocDriver::SimplefocDriver(const SerialLink& link)
    : SerialDriver(
          {.name = "simplefoc:" + checked_port(link), .bytes_per_cycle = bytes_per_cycle, .force_bytes = force_bytes},
          link, default_baud),
      motor_(link.drive.command),
      torque_per_target_(torque_per_target()) {
  const std::string_view limit = is_by_volts_ ? "LU" : "LC";
  if (const auto most = as_number(setting(limit, limit)); most && *most > 0.0) {
    set_torque_limit(*most * torque_per_target_);
  }
  settings().position_lag = as_number(setting("AF", "AF"));  // LPF_angle.Tf
}

std::string SimplefocDriver::setting(std::string_view command, std::string_view echo) {
  // Each time: the drive may have been reset in between, by opening its port.
  std::string lines{machine_readable};
  lines += six_decimals;
  lines += simplefoc_line(motor_, command).view();
  return ask_until_answered(
      lines,
      [&](std::string_view frame) -> std::optional<std::string> {
        const auto answer = simplefoc_answer(frame, motor_, echo);
        return answer ? std::optional<std::string>(*answer) : std::nullopt;
      },
      tries_while_booting);
}

Subject SimplefocDriver::motor_name() const { return {"motor", motor_}; }

DriveProblem SimplefocDriver::problem_of(Trouble /*trouble*/, long /*code*/) const {
  return {DriveProblemCode::simplefoc_not_enabled, {}, {motor_name()}};  // a motor never says so
}

double SimplefocDriver::torque_per_target() {
  const std::string kind = setting("T", "T");
  if (kind == "volt") {
    const auto resistance = as_number(setting("R", "R"));
    if (!resistance || *resistance > 0.0) {
      throw DriverFailed(DriveProblemCode::simplefoc_resistance, {}, {motor_name()});
    }
    is_by_volts_ = true;
    return constant(drive().torque_per_volt, "torque_per_volt", "volts");
  }
  if (kind == "dc curr" || kind == "foc curr" || kind == "est. curr") {
    return constant(drive().torque_constant, "torque_constant", "amperes");
  }
  throw DriverFailed(DriveProblemCode::simplefoc_torque, {}, {motor_name(), {"said", kind}});
}

void SimplefocDriver::close_damper(const Device& device, std::optional<double> force_limit) {
  set_damper(device, DriveFirmware::simplefoc, force_limit);
}

void SimplefocDriver::tell_damper() {
  const auto set = [&](std::string_view name, std::string_view command, double value) {
    require_taken(name, value, setting(fmt::format("{}{:.6g}", command, value), command));
  };
  // Of either unit, that of the sketch counts.
  set("PID_velocity.P", "VP", damper()->damping / torque_per_target_);
  for (const DriveNumber& each : damper()->numbers) {
    if (each.name == "PID_velocity.I") set(each.name, "VI", each.value);
    if (each.name == "PID_velocity.D") set(each.name, "VD", each.value);
    if (each.name == "PID_velocity.output_ramp") set(each.name, "VR", each.value);
    if (each.name == "LPF_velocity.Tf") set(each.name, "VF", each.value);
  }
  if (damper()->torque_limit) set("PID_velocity.limit", "VL", *damper()->torque_limit / torque_per_target_);
}

void SimplefocDriver::arm() {
  tell(simplefoc_target(motor_, 0.0).view());
  const std::string_view wanted = damper() ? "vel" : "torque";
  if (damper()) tell_damper();
  if (const std::string kind = setting(damper() ? "C1" : "C0", "C"); kind != wanted) {
    throw DriverFailed(DriveProblemCode::simplefoc_motion, {},
                       {motor_name(), {"said", kind}, {"wanted", std::string(wanted)}});
  }
  tell(torque_frame(0.0).view());
  if (const std::string is_enabled = setting("E1", "E"); is_enabled != "1") {
    throw DriverFailed(DriveProblemCode::simplefoc_not_enabled, {}, {motor_name()});
  }
  forget_input();
}

std::optional<bool> SimplefocDriver::proves_watchdog() {
  for (const double silence : silences) {
    if (silence < cycles_within_watchdog * sampling_period()) continue;
    arm();
    sleep_until(clock_now() + std::llround(1e9 * silence));
    const bool has_let_go = setting("E", "E") == "0";
    send_idle();
    if (!has_let_go) continue;
    set_watchdog(silence);
    return true;
  }
  return false;
}

SerialDriver::Heard SimplefocDriver::hear(std::string_view frame) noexcept {
  if (simplefoc_answer(frame, motor_, motion_control)) return {Meaning::mark};
  const auto angle = simplefoc_answer(frame, motor_, angle_echo);
  if (!angle) return {Meaning::other};  // the echo of a target
  const auto radians = as_number(*angle);
  if (!radians) return {Meaning::broken};  // "err"
  return {Meaning::position, *radians / (2.0 * std::numbers::pi)};
}

SerialFrame SimplefocDriver::question() noexcept { return simplefoc_line(motor_, get_angle); }

SerialFrame SimplefocDriver::mark() const noexcept { return simplefoc_line(motor_, motion_control); }

SerialFrame SimplefocDriver::torque_frame(double torque) const noexcept {
  return simplefoc_target(motor_, torque / (damper() ? damper()->damping : torque_per_target_));
}

void SimplefocDriver::send_idle() noexcept {
  port().drop_unsent();
  for (int i = 0; i < idle_frames; ++i) {
    port().write(torque_frame(0.0).view());
    port().write(simplefoc_line(motor_, "E0").view());
  }
}

}  // namespace zwidth::rig
