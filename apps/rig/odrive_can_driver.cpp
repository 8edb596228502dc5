#include "rig/odrive_can_driver.hpp"

#include <cmath>
#include <memory>

#include "rig/can_link.hpp"
#include "rig/can_text.hpp"
#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

constexpr double can_bitrate = 250e3;                       // can.config.baud_rate
constexpr int largest_node = 62;                            // 63 is an axis of 0.6 that has none yet
constexpr double assumed_watchdog = 1.0;                    // s, at most, until it is proved
constexpr double silence = 1.2;                             // s, after which it must have let go
constexpr std::int64_t heartbeat_patience = 1'500'000'000;  // ns: 100 ms apart by default
constexpr std::int64_t longest_without_heartbeat = 1'000'000'000;
constexpr std::int64_t unasked_patience = 300'000'000;
constexpr std::int64_t version_patience = 100'000'000;
constexpr int version_tries = 3;
constexpr std::int64_t arming_patience = 3'000'000'000;
constexpr std::int64_t between_looks = 10'000'000;
constexpr int idle_frames = 2;

constexpr double default_bandwidth = 1000.0;  // rad/s, encoder.config.bandwidth, which CANSimple does not tell

constexpr unsigned idle = 1;
constexpr unsigned closed_loop = 8;
constexpr std::uint32_t watchdog_of_5 = 1U << 11;
constexpr std::uint32_t watchdog_of_6 = 1U << 24;

CanBitRates rates_of(const SerialLink& link) { return can_rates(link, can_bitrate); }

DriverFacts facts_of(const SerialLink& link) {
  const int node = link.drive.id.value_or(0);
  if (node > largest_node) {
    throw DriverFailed(DriveProblemCode::id_out_of_range,
                       {{"id", static_cast<double>(node)}, {"least", 0.0}, {"most", static_cast<double>(largest_node)}},
                       {{"drive", "odrive-can"}});
  }
  const CanCycle cycle{{odrive_question(node, OdriveMessage::encoder_estimates).shape(), {8}},
                       {odrive_input_torque(node, 0.0).shape()},
                       rates_of(link)};
  return on_can_bus({.name = "odrive-can:" + link.port, .watchdog = assumed_watchdog}, link, cycle);
}

}  // namespace

OdriveCanDriver::OdriveCanDriver(const SerialLink& link)
    : SerialDriver(facts_of(link), link, [&] { return std::make_unique<CanLinePort>(bus_of(link, rates_of(link))); }),
      node_(link.drive.id.value_or(0)) {
  const auto first = listen(heartbeat_patience, false).heartbeat;
  if (!first) throw DriverFailed(DriveProblemCode::no_heartbeat, {{"node", static_cast<double>(node_)}});
  if (listen(unasked_patience, true).has_unasked) throw DriverFailed(DriveProblemCode::sends_unasked);
  is_6_ = is_version_6();
  if ((first->error & ~(is_6_ ? watchdog_of_6 : watchdog_of_5)) != 0) {
    throw DriverFailed(problem_of(Trouble::fault, static_cast<long>(first->error)));
  }
  settings().firmware = is_6_ ? "0.6" : "0.5";
  settings().tracking_bandwidth = default_bandwidth;
  settings().is_filter_assumed = true;
  (void)ask_until_answered(question().view(), [&](std::string_view frame) -> std::optional<std::string> {
    return hear(frame).meaning == Meaning::position ? std::optional<std::string>("") : std::nullopt;
  });
}

OdriveCanDriver::Listened OdriveCanDriver::listen(std::int64_t patience, bool until_end) {
  Listened found;
  (void)ask(
      {},
      [&](std::string_view line) -> std::optional<std::string> {
        const auto frame = fdcanusb_frame(line);
        const auto message = frame ? odrive_message(*frame, node_) : std::nullopt;
        if (message == OdriveMessage::heartbeat) found.heartbeat = odrive_heartbeat(*frame);
        if (message == OdriveMessage::encoder_estimates || message == OdriveMessage::bus_voltage)
          found.has_unasked = true;
        return found.heartbeat && !until_end ? std::optional<std::string>("") : std::nullopt;
      },
      patience);
  return found;
}

bool OdriveCanDriver::is_version_6() {
  for (int i = 0; i < version_tries; ++i) {
    const auto minor = ask(
        fdcanusb_line(odrive_question(node_, OdriveMessage::version)).view(),
        [&](std::string_view line) -> std::optional<std::string> {
          const auto frame = fdcanusb_frame(line);
          if (!frame || odrive_message(*frame, node_) != OdriveMessage::version) return std::nullopt;
          const OdriveVersion version = odrive_version(*frame);
          return fmt::format("{}", version.major > 0 || version.minor > 5);
        },
        version_patience);
    if (minor) return *minor == "true";
  }
  return false;
}

void OdriveCanDriver::request_closed_loop() {
  const auto say = [&](const CanFrame& frame) { tell(fdcanusb_line(frame).view()); };
  say(odrive_clear_errors(node_));  // the watchdog's own error, from the silence before
  say(odrive_torque_mode(node_));
  say(odrive_input_torque(node_, 0.0));
  say(odrive_state(node_, closed_loop));
}

void OdriveCanDriver::arm() {
  const std::uint32_t watchdog = is_6_ ? watchdog_of_6 : watchdog_of_5;
  const std::int64_t until = clock_now() + arming_patience;
  is_armed_ = false;
  trouble_.reset();
  forget_input();
  request_closed_loop();
  std::optional<OdriveHeartbeat> last;
  while (!last || last->state != closed_loop || last->error != 0) {
    if (clock_now() > until) {
      throw DriverFailed(
          DriveProblemCode::odrive_not_closed_loop,
          {{"node", static_cast<double>(node_)}, {"error", last ? static_cast<double>(last->error) : 0.0}});
    }
    if (last && (last->error & watchdog) != 0) request_closed_loop();  // it bit while an answer was under way
    tell(torque_frame(0.0).view());
    if (const auto heard = listen(between_looks, false).heartbeat) last = heard;
  }
  tell(torque_frame(0.0).view());
  forget_input();
  heard_ = clock_now();
  is_armed_ = true;
}

std::optional<bool> OdriveCanDriver::proves_watchdog() {
  const std::uint32_t watchdog = is_6_ ? watchdog_of_6 : watchdog_of_5;
  for (int i = 0; i < proofs; ++i) {
    arm();
    is_armed_ = false;
    const std::int64_t begin = clock_now();
    bool has_let_go = false;
    while (!has_let_go && clock_now() < begin + std::llround(1e9 * silence)) {
      const auto heartbeat = listen(between_looks, false).heartbeat;  // in silence: of 0.5 a question feeds it, too
      has_let_go = heartbeat && heartbeat->state != closed_loop && (heartbeat->error & watchdog) != 0;
    }
    const std::int64_t end = clock_now();
    send_idle();
    if (!has_let_go) continue;
    set_watchdog(1e-9 * static_cast<double>(end - begin));
    return true;
  }
  set_watchdog(std::nullopt);
  return false;
}

SerialDriver::Heard OdriveCanDriver::hear(std::string_view line) noexcept {
  const auto frame = fdcanusb_frame(line);
  const auto message = frame ? odrive_message(*frame, node_) : std::nullopt;
  if (message == OdriveMessage::bus_voltage) return {Meaning::mark};
  if (message == OdriveMessage::heartbeat) {
    const OdriveHeartbeat heartbeat = odrive_heartbeat(*frame);
    heard_ = clock_now();
    if (is_armed_ && (heartbeat.error != 0 || heartbeat.state != closed_loop)) trouble_ = heartbeat;
  }
  if (message != OdriveMessage::encoder_estimates) return {Meaning::other};
  if (!is_armed_ || is_disarmed()) return {Meaning::position, odrive_position(*frame)};
  if (trouble_) {
    return trouble_->error != 0 ? Heard{Meaning::broken, 0.0, Trouble::fault, static_cast<long>(trouble_->error)}
                                : Heard{Meaning::broken, 0.0, Trouble::let_go, static_cast<long>(trouble_->state)};
  }
  // Whether its torque is on is not known any more.
  if (!facts().lock_step && clock_now() - heard_ > longest_without_heartbeat) return {Meaning::broken};
  return {Meaning::position, odrive_position(*frame)};
}

DriveProblem OdriveCanDriver::problem_of(Trouble trouble, long code) const {
  const Evidence node{"node", static_cast<double>(node_)};
  if (trouble != Trouble::fault) {
    return {DriveProblemCode::odrive_let_go, {node, {"state", static_cast<double>(code)}}};
  }
  DriveProblem problem{DriveProblemCode::odrive_fault, {node, {"error", static_cast<double>(code)}}};
  const auto watchdog = static_cast<long>(is_6_ ? watchdog_of_6 : watchdog_of_5);
  if ((code & watchdog) != 0) problem.evidence.push_back({"watchdog", 1.0});
  return problem;
}

SerialFrame OdriveCanDriver::question() noexcept {
  return fdcanusb_line(odrive_question(node_, OdriveMessage::encoder_estimates));
}

SerialFrame OdriveCanDriver::mark() const noexcept {
  return fdcanusb_line(odrive_question(node_, OdriveMessage::bus_voltage));
}

SerialFrame OdriveCanDriver::torque_frame(double torque) const noexcept {
  return fdcanusb_line(odrive_input_torque(node_, torque));
}

void OdriveCanDriver::send_idle() noexcept {
  port().drop_unsent();
  for (int i = 0; i < idle_frames; ++i) {
    port().write(torque_frame(0.0).view());
    port().write(fdcanusb_line(odrive_state(node_, idle)).view());
  }
}

}  // namespace zwidth::rig
