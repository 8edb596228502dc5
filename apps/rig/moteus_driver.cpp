#include "rig/moteus_driver.hpp"

#include <memory>
#include <numbers>
#include <string>

#include "rig/can_link.hpp"
#include "rig/can_text.hpp"
#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

constexpr int default_baud = 921600;
constexpr double watchdog = 0.1;               // s
constexpr std::int64_t silence = 250'000'000;  // ns, after which it must have let go
constexpr std::int64_t refusal_patience = 100'000'000;
constexpr std::int64_t arming_patience = 2'000'000'000;  // a busy machine hands answers on late
constexpr std::int64_t between_looks = 10'000'000;
constexpr int idle_frames = 2;

constexpr double can_bitrate = 1e6;
constexpr double can_data_bitrate = 5e6;
constexpr CanFrameShape can_answer{12, false, false, true};  // mode and position, with their padding

// "can send 8001 11001d01 *XX", "OK *XX", "rcv 00000100 21000a2d01xxxxxxxx *XX", a torque and its "OK *XX", with ends.
constexpr double bytes_per_cycle = 27 + 8 + 37 + 57 + 8;
constexpr double force_bytes = 57;
constexpr double bytes_of_damper = 32;  // of a torque beside it: no position, velocity 0, and a limit

constexpr std::string_view first_with_uart = "0.1.14 (April 2026)";
constexpr unsigned first_with_cutoff = 0x00010c;
constexpr int setup_tries = 2;  // an answer may be lost
constexpr double cutoff_over_bandwidth = 2.48;
constexpr double position_sources = 3.0;

constexpr int largest_id = 127;
constexpr int fault_mode = 1;
constexpr int position_mode = 10;
constexpr int timeout_mode = 11;

/// What the port alone would not tell, before it is opened.
const std::string& checked_port(const SerialLink& link) {
  const int id = link.drive.id.value_or(1);
  if (id < 1 || id > largest_id) {
    throw DriverFailed(DriveProblemCode::id_out_of_range,
                       {{"id", static_cast<double>(id)}, {"least", 1.0}, {"most", static_cast<double>(largest_id)}},
                       {{"drive", "moteus"}});
  }
  return link.port;
}

CanBitRates rates_of(const SerialLink& link) { return can_rates(link, can_bitrate, can_data_bitrate); }

/// Of what a line has an fdcanusb send.
CanFrameShape shape_of(const SerialFrame& line) { return fdcanusb_order(line.view()).value_or(CanFrame{}).shape(); }

DriverFacts facts_of(const SerialLink& link) {
  const int id = link.drive.id.value_or(1);
  if (link.is_can) {
    return on_can_bus(
        {.name = "moteus-can:" + checked_port(link), .watchdog = watchdog, .estimates_velocity = true}, link,
        {{shape_of(moteus_question(id)), can_answer}, {shape_of(moteus_torque(id, 0.0, watchdog))}, rates_of(link)});
  }
  return on_serial_line({.name = "moteus:" + checked_port(link),
                         .watchdog = watchdog,
                         .bytes_per_cycle = bytes_per_cycle,
                         .force_bytes = force_bytes,
                         .estimates_velocity = true},
                        link, default_baud);
}

OpenPort port_of(const SerialLink& link) {
  if (!link.is_can) return serial_port_of(link, default_baud);
  return [&link] { return std::make_unique<CanLinePort>(bus_of(link, rates_of(link))); };
}

}  // namespace

MoteusDriver::MoteusDriver(const SerialLink& link)
    : SerialDriver(facts_of(link), link, port_of(link)),
      id_(link.drive.id.value_or(1)),
      can_rates_(link.is_can ? std::optional(rates_of(link)) : std::nullopt),
      has_checksums_(!link.is_can) {
  if (has_checksums_) {
    // An fdcanusb takes the checksum for a flag that it does not know, and says so.
    const auto refused = ask(
        line(moteus_question(id_)).view(),
        [](std::string_view frame) -> std::optional<std::string> {
          return frame.starts_with("ERR") ? std::optional<std::string>(frame) : std::nullopt;
        },
        refusal_patience);
    if (refused) has_checksums_ = moteus_answer(*refused, true).has_value();
  }
  if (const int found = mode(); found == fault_mode) throw DriverFailed(problem_of(Trouble::fault, found));
  read_firmware();
}

DriveProblem MoteusDriver::unanswered() const {
  DriveProblem problem = SerialDriver::unanswered();
  if (!can_rates_) problem.subjects.push_back({"firmware", std::string(first_with_uart)});
  return problem;
}

std::optional<double> MoteusDriver::configured(std::string_view name) {
  tell(line(moteus_tunnel(id_, fmt::format("conf get {}\n", name))).view());
  const auto understood = [&](std::string_view frame) -> std::optional<std::string> {
    const auto answer = moteus_answer(frame, has_checksums_);
    return answer ? moteus_tunnel_reply(*answer, id_) : std::nullopt;
  };
  std::optional<std::string> text;
  for (int i = 0; i < setup_tries && !text; ++i) text = ask(line(moteus_tunnel_question(id_)).view(), understood);
  return text ? as_number(*text) : std::nullopt;
}

void MoteusDriver::read_firmware() {
  const auto understood = [&](std::string_view frame) -> std::optional<std::string> {
    const auto answer = moteus_answer(frame, has_checksums_);
    const auto reply = answer ? moteus_reply(*answer, id_) : std::nullopt;
    return reply && reply->firmware ? std::optional(fmt::format("{}", *reply->firmware)) : std::nullopt;
  };
  std::optional<std::string> text;
  for (int i = 0; i < setup_tries && !text; ++i) text = ask(line(moteus_version_question(id_)).view(), understood);
  if (text) {
    const auto version = static_cast<unsigned>(as_number(*text).value_or(0.0));
    settings().firmware = fmt::format("{}.{}.{}", version >> 16U, version >> 8U & 0xffU, version & 0xffU);
    read_position_filter(version);
  }
  const auto after = configured("servo.timeout_mode");
  if (!after) return;
  settings().mode_after_watchdog = static_cast<int>(*after);
  if (settings().mode_after_watchdog != position_mode) return;
  throw DriverFailed(DriveProblemCode::moteus_holds, {{"id", static_cast<double>(id_)}, {"mode", *after}});
}

void MoteusDriver::read_position_filter(unsigned version) {
  const auto source = configured("motor_position.output.source");
  if (!source || !(*source >= 0.0 && *source < position_sources)) return;
  const auto hertz = configured(fmt::format("motor_position.sources.{:.0f}.pll_filter_hz", *source));
  // By 3 dB of (2 w s + w²)/(s + w)² since 0.1.12, by w itself before.
  const double ratio = version >= first_with_cutoff ? cutoff_over_bandwidth : 1.0;
  if (hertz && *hertz >= 0.0) settings().tracking_bandwidth = 2.0 * std::numbers::pi * *hertz / ratio;
}

int MoteusDriver::mode() {
  const std::string text =
      ask_until_answered(question().view(), [&](std::string_view frame) -> std::optional<std::string> {
        const auto answer = moteus_answer(frame, has_checksums_);
        const auto reply = answer ? moteus_reply(*answer, id_) : std::nullopt;
        return reply && reply->mode ? std::optional(fmt::format("{}", *reply->mode)) : std::nullopt;
      });
  return std::stoi(text);
}

void MoteusDriver::close_damper(const Device& device, std::optional<double> force_limit) {
  set_damper(device, DriveFirmware::moteus, force_limit);
  if (!can_rates_) return add_force_bytes(bytes_of_damper);
  const CanFrameShape bare = shape_of(moteus_torque(id_, 0.0, watchdog));
  const CanFrameShape damped = shape_of(moteus_damped_torque(id_, 0.0, damper()->torque_limit, watchdog));
  add_force_bytes(2.0 * (damped.bytes - bare.bytes),
                  can_frame_time(damped, *can_rates_) - can_frame_time(bare, *can_rates_));
}

std::string MoteusDriver::said_to(const std::string& text) {
  tell(line(moteus_tunnel(id_, text)).view());
  return ask_until_answered(line(moteus_tunnel_question(id_)).view(), [&](std::string_view frame) {
    const auto answer = moteus_answer(frame, has_checksums_);
    return answer ? moteus_tunnel_reply(*answer, id_) : std::nullopt;
  });
}

void MoteusDriver::tell_damper() {
  for (const DriveNumber& each : damper()->numbers) {
    const std::string answer = said_to(fmt::format("conf set {} {:.6g}\n", each.name, each.value));
    if (answer != "OK") {
      throw DriverFailed(DriveProblemCode::moteus_refuses_number, {{"id", static_cast<double>(id_)}},
                         {{"name", std::string(each.name)}, {"said", answer}});
    }
    require_taken(each.name, each.value, said_to(fmt::format("conf get {}\n", each.name)));
  }
}

void MoteusDriver::arm() {
  if (damper()) tell_damper();
  const std::int64_t until = clock_now() + arming_patience;
  std::int64_t pause = between_looks;
  do {
    tell(line(moteus_stop(id_)).view());  // each time: its watchdog may bite while an answer is under way
    tell(torque_frame(0.0).view());
    if (mode() == position_mode) {
      tell(torque_frame(0.0).view());
      return forget_input();
    }
    sleep_until(clock_now() + pause);
    pause *= 2;  // an answer that is late passes for that of the next question, until a pause lets all of them in
  } while (clock_now() < until);
  throw DriverFailed(DriveProblemCode::moteus_other_mode,
                     {{"id", static_cast<double>(id_)}, {"mode", static_cast<double>(mode())}});
}

std::optional<bool> MoteusDriver::proves_watchdog() {
  for (int i = 0; i < proofs; ++i) {
    arm();
    sleep_until(clock_now() + silence);
    const bool has_let_go = mode() == timeout_mode;
    send_idle();
    if (has_let_go) return true;
  }
  set_watchdog(std::nullopt);
  return false;
}

SerialDriver::Heard MoteusDriver::hear(std::string_view frame) noexcept {
  const auto answer = moteus_answer(frame, has_checksums_);
  if (!answer) return {Meaning::broken};
  if (*answer == "OK" || answer->empty()) return {Meaning::other};
  const auto reply = moteus_reply(*answer, id_);
  if (reply && reply->fault) return {Meaning::mark};
  if (!reply || !reply->position) return {Meaning::broken};
  if (reply->mode != position_mode && !is_disarmed()) {
    const int mode = reply->mode.value_or(0);
    return {Meaning::broken, 0.0, mode == fault_mode ? Trouble::fault : Trouble::let_go, mode};
  }
  return {Meaning::position, *reply->position};
}

DriveProblem MoteusDriver::problem_of(Trouble trouble, long code) const {
  const Evidence id{"id", static_cast<double>(id_)};
  if (trouble == Trouble::fault) return {DriveProblemCode::moteus_fault, {id}};
  return {DriveProblemCode::moteus_let_go, {id, {"mode", static_cast<double>(code)}}};
}

SerialFrame MoteusDriver::question() noexcept { return line(moteus_question(id_)); }

SerialFrame MoteusDriver::mark() const noexcept { return line(moteus_mark(id_)); }

SerialFrame MoteusDriver::torque_frame(double torque) const noexcept {
  if (!damper()) return line(moteus_torque(id_, torque, watchdog));
  return line(moteus_damped_torque(id_, torque, damper()->torque_limit, watchdog));
}

void MoteusDriver::send_idle() noexcept {
  port().drop_unsent();
  for (int i = 0; i < idle_frames; ++i) port().write(line(moteus_stop(id_)).view());
}

}  // namespace zwidth::rig
