#include "rig/odrive_driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "rig/odrive_protocol.hpp"
#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

constexpr int default_baud = 115200;
constexpr double shortest_watchdog = 0.1;  // s
constexpr double longest_watchdog = 0.5;
constexpr double watchdog_cycles = 4.0;      // more than the loop may miss: it stops before the drive does
constexpr std::int64_t grace = 150'000'000;  // ns, after which it must have let go
constexpr unsigned cycles_between_errors = 8;
constexpr std::int64_t arming_patience = 2'000'000'000;  // a busy machine hands answers on late
constexpr std::int64_t between_looks = 10'000'000;
constexpr int idle_frames = 2;

// Lines with their ends: "f 0*118", "-12.345678 -12.345678*123", "c 0 -1.23456e-05*123", "r axis0.error*96", "0*48".
constexpr double bytes_per_cycle = 8 + 27 + 21 + 17 + 6;
constexpr double force_bytes = 21;
constexpr double bytes_of_velocity = 2;  // of "v 0 0 ..."

// Of odrive-interface.yaml; 0.6 has errors of its own, and other names of its limits.
constexpr std::string_view error_of_0_6 = "active_errors";
constexpr std::string_view idle = "1";
constexpr std::string_view closed_loop = "8";
constexpr std::string_view torque_control = "1";
constexpr std::string_view velocity_control = "2";
constexpr std::string_view passthrough = "1";
constexpr std::string_view supply_voltage = "r vbus_voltage";
constexpr long watchdog_expired_of_0_6 = 1L << 24;
constexpr double largest_error = 0xffffffff;

double watchdog_of(const SerialLink& link) {
  return std::clamp(watchdog_cycles * link.sampling_period, shortest_watchdog, longest_watchdog);
}

/// What the port alone would not tell, before it is opened.
const std::string& checked_port(const SerialLink& link) {
  const int axis = link.drive.id.value_or(0);
  if (axis > 1) {
    throw DriverFailed(DriveProblemCode::id_out_of_range,
                       {{"id", static_cast<double>(axis)}, {"least", 0.0}, {"most", 1.0}}, {{"drive", "odrive"}});
  }
  return link.port;
}

}  // namespace

OdriveDriver::OdriveDriver(const SerialLink& link)
    : SerialDriver({.name = "odrive:" + checked_port(link),
                    .watchdog = watchdog_of(link),
                    .bytes_per_cycle = bytes_per_cycle,
                    .force_bytes = force_bytes,
                    .estimates_velocity = true},
                   link, default_baud),
      axis_(link.drive.id.value_or(0)),
      watchdog_(watchdog_of(link)) {
  read_firmware();
  if (const long found = error(); (found & ~watchdog_expired_) != 0) {
    throw DriverFailed(problem_of(Trouble::fault, found));
  }
  read_limits();
  settings().tracking_bandwidth = first_number_of({"encoder.config.bandwidth", "config.encoder_bandwidth"});
}

OdriveDriver::~OdriveDriver() {
  if (settings_.empty()) return;
  disarm();
  for (const auto& [name, value] : settings_) {
    port().write(odrive_line(fmt::format("w axis{}.{} {}", axis_, name, value)).view());
  }
  port().write(odrive_line("sc").view());  // its watchdog bit while nothing came
}

std::size_t OdriveDriver::frame_size(std::string_view bytes) const noexcept {
  return ends_lines_ ? SerialDriver::frame_size(bytes) : odrive_unended_answer_size(bytes);
}

void OdriveDriver::read_firmware() {
  const SerialFrame line = odrive_line(fmt::format("r axis{}.{}", axis_, error_name_));
  const auto heard = [](std::string_view frame) -> std::optional<std::string> {
    const auto answer = odrive_answer(frame);
    return answer ? std::optional(std::string(*answer)) : std::nullopt;
  };
  std::optional<std::string> text;
  for (int i = 0; i < 4 && !text; ++i) {
    ends_lines_ = i % 2 == 0;
    text = ask(line.view(), heard);
  }
  if (!text) ends_lines_ = true;
  if (!text || as_number(*text)) return;
  error_name_ = error_of_0_6;
  torque_limit_name_ = "config.torque_soft_max";
  watchdog_expired_ = watchdog_expired_of_0_6;
}

std::string OdriveDriver::said_of(std::string_view name) {
  const SerialFrame line = odrive_line(fmt::format("r axis{}.{}", axis_, name));
  return ask_until_answered(line.view(), [](std::string_view frame) -> std::optional<std::string> {
    const auto answer = odrive_answer(frame);
    if (!answer || odrive_feedback(*answer)) return std::nullopt;
    return std::string(*answer);
  });
}

std::optional<double> OdriveDriver::first_number_of(std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    if (const auto number = as_number(said_of(name))) return number;
  }
  return std::nullopt;
}

void OdriveDriver::keep_settings() {
  if (!settings_.empty()) return;
  for (const std::string_view name : {"config.enable_watchdog", "config.watchdog_timeout",
                                      "controller.config.control_mode", "controller.config.input_mode"}) {
    settings_.emplace_back(name, property(name));
  }
}

void OdriveDriver::read_limits() {
  const auto torque = first_number_of({torque_limit_name_});
  const auto current = first_number_of({"motor.config.current_lim", "config.motor.current_soft_max"});
  const auto constant = first_number_of({"motor.config.torque_constant", "config.motor.torque_constant"});
  double least = torque.value_or(std::numeric_limits<double>::infinity());
  if (current && constant) least = std::min(least, *current * *constant);
  // In torque control the velocity limit leaves (vel_limit - velocity) vel_gain (limitVel() of controller.cpp).
  const auto limits_velocity = first_number_of(
      {"controller.config.enable_torque_mode_vel_limit", "controller.config.enable_current_mode_vel_limit"});
  if (limits_velocity.value_or(0.0) != 0.0) {
    const auto velocity = first_number_of({"controller.config.vel_limit"});
    const auto gain = first_number_of({"controller.config.vel_gain"});
    if (velocity && gain) least = std::min(least, *velocity * *gain);
  }
  if (std::isfinite(least)) set_torque_limit(least);
}

std::string OdriveDriver::property(std::string_view name) {
  const std::string text = said_of(name);
  if (!as_number(text)) {
    throw DriverFailed(DriveProblemCode::odrive_property, {{"axis", static_cast<double>(axis_)}},
                       {{"said", text}, {"name", std::string(name)}});
  }
  return text;
}

void OdriveDriver::set_property(std::string_view name, std::string_view value) {
  tell(odrive_line(fmt::format("w axis{}.{} {}", axis_, name, value)).view());
}

long OdriveDriver::error() { return std::strtol(property(error_name_).c_str(), nullptr, 10); }

void OdriveDriver::close_damper(const Device& device, std::optional<double> force_limit) {
  set_damper(device, DriveFirmware::odrive, force_limit);
  add_force_bytes(bytes_of_velocity);
}

void OdriveDriver::tell_damper() {
  const auto set = [&](std::string_view name, double value) {
    set_property(name, fmt::format("{:.9g}", value));
    require_taken(name, value, property(name));
  };
  if (damper()->torque_limit) set(torque_limit_name_, *damper()->torque_limit);
  for (const DriveNumber& each : damper()->numbers) {
    set(std::string_view(each.name).substr(each.name.find('.') + 1), each.value);
  }
}

void OdriveDriver::request_closed_loop() {
  // The watchdog's own error, from the silence before; 0.5.1 has no `sc`, and 0.6 does not let its errors be written.
  tell(odrive_line("sc").view());
  if (error_name_ != error_of_0_6) set_property(error_name_, "0");
  set_property("controller.config.control_mode", damper() ? velocity_control : torque_control);
  set_property("controller.config.input_mode", passthrough);
  set_property("config.watchdog_timeout", fmt::format("{}", watchdog_));
  tell(torque_frame(0.0).view());
  set_property("config.enable_watchdog", "1");
  set_property("requested_state", closed_loop);
}

void OdriveDriver::arm() {
  keep_settings();
  if (damper()) tell_damper();
  const std::int64_t until = clock_now() + arming_patience;
  request_closed_loop();
  while (property("current_state") != closed_loop) {
    const long found = error();
    if (clock_now() > until) {
      throw DriverFailed(DriveProblemCode::odrive_not_closed_loop,
                         {{"axis", static_cast<double>(axis_)}, {"error", static_cast<double>(found)}});
    }
    if ((found & watchdog_expired_) != 0) request_closed_loop();  // it bit while an answer was under way
    tell(torque_frame(0.0).view());
    sleep_until(clock_now() + between_looks);
  }
  tell(torque_frame(0.0).view());
  error_ = 0;
  forget_input();
}

std::optional<bool> OdriveDriver::proves_watchdog() {
  for (int i = 0; i < proofs; ++i) {
    arm();
    sleep_until(clock_now() + std::llround(1e9 * watchdog_) + grace);
    const bool has_let_go = property("current_state") == idle && (error() & watchdog_expired_) != 0;
    send_idle();
    if (has_let_go) return true;
  }
  set_watchdog(std::nullopt);
  return false;
}

SerialDriver::Heard OdriveDriver::hear(std::string_view frame) noexcept {
  const auto answer = odrive_answer(frame);
  if (!answer) return {Meaning::broken};
  if (const auto feedback = odrive_feedback(*answer)) {
    if (error_ != 0) return {Meaning::broken, 0.0, Trouble::fault, error_};
    return {Meaning::position, feedback->position};
  }
  const auto error = as_number(*answer);
  if (!error) return {Meaning::broken};                                     // "invalid motor", "unknown command"
  if (answer->find('.') != std::string_view::npos) return {Meaning::mark};  // an error is a whole number
  if (*error != 0.0) error_ = *error >= 1.0 && *error <= largest_error ? std::lround(*error) : 1;
  return {Meaning::other};
}

DriveProblem OdriveDriver::problem_of(Trouble /*trouble*/, long code) const {
  DriveProblem problem{DriveProblemCode::odrive_fault,
                       {{"axis", static_cast<double>(axis_)}, {"error", static_cast<double>(code)}}};
  if ((code & watchdog_expired_) != 0) problem.evidence.push_back({"watchdog", 1.0});
  return problem;
}

SerialFrame OdriveDriver::question() noexcept {
  SerialFrame feedback;
  feedback.print("f {}", axis_);
  SerialFrame lines = odrive_line(feedback.view());
  if (++asked_ % cycles_between_errors == 0) {
    SerialFrame error;
    error.print("r axis{}.{}", axis_, error_name_);
    lines.add(odrive_line(error.view()).view());
  }
  return lines;
}

SerialFrame OdriveDriver::mark() const noexcept { return odrive_line(supply_voltage); }

SerialFrame OdriveDriver::torque_frame(double torque) const noexcept {
  return odrive_line((damper() ? odrive_damped_torque(axis_, torque) : odrive_torque(axis_, torque)).view());
}

void OdriveDriver::send_idle() noexcept {
  port().drop_unsent();
  SerialFrame state;
  state.print("w axis{}.requested_state {}", axis_, idle);
  for (int i = 0; i < idle_frames; ++i) {
    port().write(torque_frame(0.0).view());
    port().write(odrive_line(state.view()).view());
  }
}

}  // namespace zwidth::rig
