#include "rig/vesc_driver.hpp"

#include <cmath>
#include <memory>
#include <string>

#include "rig/can_link.hpp"
#include "rig/real_time.hpp"
#include "rig/vesc_can_port.hpp"
#include "zwidth/error.hpp"

namespace zwidth::rig {
namespace {

constexpr int default_baud = 115200;
constexpr double default_watchdog = 1.0;                 // s, APPCONF_TIMEOUT_MSEC
constexpr double silence = 1.2;                          // s, after which it must have let go
constexpr std::int64_t arming_patience = 2'000'000'000;  // ns: a busy machine hands answers on late
constexpr std::int64_t between_looks = 10'000'000;
constexpr int idle_frames = 3;
constexpr double most_share_per_cycle = 0.25;  // of the turns that its position is modulo
constexpr int oldest_major = 6;                // whose answers tell whether it has let go
constexpr int setup_tries = 2;                 // an answer may be lost

// Question, answer, current.
constexpr double bytes_per_cycle = 10 + 16 + 10;
constexpr double force_bytes = 10;

constexpr double can_bitrate = 500e3;
constexpr int largest_id = vesc_can_host - 1;

CanBitRates rates_of(const SerialLink& link) { return can_rates(link, can_bitrate); }

int can_id_of(const SerialLink& link) {
  if (!link.drive.id) {
    throw Error(
        ErrorCode::invalid_argument,
        "driver.id: is missing: a VESC is told from others on a bus by it (App Settings, General, VESC ID); must be "
        "given, such as 23");
  }
  if (*link.drive.id > largest_id) {
    throw DriverFailed(
        DriveProblemCode::id_out_of_range,
        {{"id", static_cast<double>(*link.drive.id)}, {"least", 0.0}, {"most", static_cast<double>(largest_id)}},
        {{"drive", "vesc-can"}});
  }
  return *link.drive.id;
}

DriverFacts facts_of(const SerialLink& link) {
  if (link.is_can) {
    (void)can_id_of(link);
    // On the bus: a question, its answer in three frames, a current.
    return on_can_bus({.name = "vesc-can:" + link.port, .watchdog = default_watchdog}, link,
                      {{{7, true}, {8, true}, {5, true}, {6, true}}, {{4, true}}, rates_of(link)});
  }
  return on_serial_line({.name = "vesc:" + link.port,
                         .watchdog = default_watchdog,
                         .bytes_per_cycle = bytes_per_cycle,
                         .force_bytes = force_bytes},
                        link, default_baud);
}

OpenPort port_of(const SerialLink& link) {
  if (!link.is_can) return serial_port_of(link, default_baud);
  return [&link] { return std::make_unique<VescCanPort>(bus_of(link, rates_of(link)), can_id_of(link)); };
}

double torque_constant_of(const SerialLink& link) {
  if (!link.drive.torque_constant) {
    throw Error(ErrorCode::invalid_argument,
                "driver.torque_constant: is missing: a VESC takes a current; must be given, such as \"50 mN m/A\"");
  }
  return *link.drive.torque_constant;
}

std::optional<std::string> payload_of_values(std::string_view frame) {
  const auto found = vesc_payload(frame);
  return found && vesc_values(*found) ? std::optional<std::string>(*found) : std::nullopt;
}

}  // namespace

VescDriver::VescDriver(const SerialLink& link) : VescDriver(link, torque_constant_of(link)) {}

VescDriver::VescDriver(const SerialLink& link, double torque_constant)
    : SerialDriver(facts_of(link), link, port_of(link)), torque_constant_(torque_constant) {
  read_firmware();
  if (const int fault = values().fault; fault != 0) {
    throw DriverFailed(problem_of(Trouble::fault, fault));
  }
}

void VescDriver::read_firmware() {
  const auto understood = [](std::string_view frame) -> std::optional<std::string> {
    const auto payload = vesc_payload(frame);
    return payload && vesc_version(*payload) ? std::optional<std::string>(*payload) : std::nullopt;
  };
  std::optional<std::string> payload;
  for (int i = 0; i < setup_tries && !payload; ++i) payload = ask(vesc_version_question().view(), understood);
  if (!payload) return;  // nor does it answer anything else, which values() says
  const VescVersion version = vesc_version(*payload).value_or(VescVersion{});
  settings().firmware = fmt::format("{}.{:02}", version.major, version.minor);
  if (version.major < oldest_major) {
    throw DriverFailed(DriveProblemCode::vesc_firmware, {}, {{"firmware", settings().firmware}});
  }
  read_settings();
}

void VescDriver::read_settings() {
  const auto understood = [](std::string_view frame) -> std::optional<std::string> {
    const auto payload = vesc_payload(frame);
    return payload && has_vesc_settings(*payload) ? std::optional<std::string>(*payload) : std::nullopt;
  };
  std::optional<std::string> payload;
  is_reading_settings_ = true;
  for (int i = 0; i < setup_tries && !payload; ++i) payload = ask(vesc_settings_question().view(), understood);
  is_reading_settings_ = false;
  const auto found = payload ? vesc_settings(*payload) : std::nullopt;
  settings().are_unknown = !found;
  if (!found) return;
  turns_modulo_ = found->angle_division;
  settings().least_current = found->least_current;
  settings().least_force = found->least_current * torque_constant_ / std::abs(drive().torque_per_force());
}

VescValues VescDriver::values() {
  return vesc_values(ask_until_answered(question().view(), payload_of_values)).value_or(VescValues{});
}

void VescDriver::arm() {
  const std::int64_t until = clock_now() + arming_patience;
  do {
    tell(torque_frame(0.0).view());
    sleep_until(clock_now() + between_looks);  // its watchdog looks every 10 ms
    // Asked once, and fed again: questions alone let the watchdog bite meanwhile.
    const auto payload = ask(question().view(), payload_of_values);
    const auto found = payload ? vesc_values(*payload) : std::nullopt;
    if (found && found->fault == 0 && !found->has_let_go) {
      tell(torque_frame(0.0).view());
      last_turns_.reset();
      has_lost_count_ = false;
      return forget_input();
    }
  } while (clock_now() < until);
  throw DriverFailed(DriveProblemCode::vesc_takes_no_current);
}

std::optional<bool> VescDriver::proves_watchdog() {
  arm();
  const std::int64_t begin = clock_now();
  bool has_let_go = false;
  while (!has_let_go && clock_now() < begin + std::llround(1e9 * silence)) {
    sleep_until(clock_now() + between_looks);
    has_let_go = values().has_let_go;  // a question does not feed it
  }
  set_watchdog(has_let_go ? std::optional(1e-9 * static_cast<double>(clock_now() - begin)) : std::nullopt);
  send_idle();
  return has_let_go;
}

SerialDriver::Heard VescDriver::hear(std::string_view frame) noexcept {
  if (frame.size() == 1) return {Meaning::other};  // noise between packets
  const auto payload = vesc_payload(frame);
  if (!payload) return {Meaning::broken};
  if (is_vesc_mark(*payload)) return {Meaning::mark};
  const auto found = vesc_values(*payload);
  if (!found) return {Meaning::other};
  if (found->fault != 0) return {Meaning::broken, 0.0, Trouble::fault, found->fault};
  if (found->has_let_go) return {Meaning::broken, 0.0, Trouble::let_go};
  double turns = turns_modulo_ * found->position;
  if (last_turns_) turns += turns_modulo_ * std::round((*last_turns_ - turns) / turns_modulo_);
  // Half of them forwards look like half of them backwards: it stops well before, and for good.
  if (last_turns_ && std::abs(turns - *last_turns_) > most_share_per_cycle * turns_modulo_) has_lost_count_ = true;
  if (has_lost_count_) return {Meaning::broken, 0.0, Trouble::lost_count};
  last_turns_ = turns;
  return {Meaning::position, turns};
}

DriveProblem VescDriver::problem_of(Trouble trouble, long code) const {
  if (trouble == Trouble::fault) return {DriveProblemCode::vesc_fault, {{"fault", static_cast<double>(code)}}};
  if (trouble == Trouble::let_go) return {DriveProblemCode::vesc_let_go};
  return {DriveProblemCode::turns_not_counted,
          {{"most", most_share_per_cycle * turns_modulo_}, {"modulo", turns_modulo_}}};
}

SerialFrame VescDriver::torque_frame(double torque) const noexcept { return vesc_current(torque / torque_constant_); }

void VescDriver::send_idle() noexcept {
  port().drop_unsent();
  for (int i = 0; i < idle_frames; ++i) port().write(torque_frame(0.0).view());
}

}  // namespace zwidth::rig
