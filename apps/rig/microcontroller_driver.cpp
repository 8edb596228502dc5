#include "rig/microcontroller_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rig/real_time.hpp"
#include "zwidth/rig/serial_rate.hpp"

namespace zwidth::rig {
namespace {

constexpr int default_baud = 1'000'000;  // what an AVR at 16 MHz makes without an error
constexpr unsigned known_version = 1;
constexpr int tries_while_booting = 12;  // many boards start anew when their port is opened: 3 s
constexpr std::int64_t booting_patience = 250'000'000;
constexpr std::int64_t setup_patience = 500'000'000;
constexpr int setup_tries = 4;            // a frame may be lost
constexpr double longest_watchdog = 1.0;  // s
constexpr double silence_over_watchdog = 2.5;
constexpr int idle_frames = 3;  // one may be lost
constexpr std::string_view frame_end("\0", 1);
constexpr double bytes_per_cycle =
    microcontroller_question_bytes + microcontroller_answer_bytes + microcontroller_force_bytes;

int baud_of(const SerialLink& link) { return link.drive.baud.value_or(default_baud); }

DriverFacts facts_of(const SerialLink& link) {
  const double baud = baud_of(link);
  if (!link.lock_step) require_fast_line(bytes_per_cycle, baud, link.sampling_period);
  return {.name = "serial:" + link.port,
          .lock_step = link.lock_step,
          .bytes_per_cycle = bytes_per_cycle,
          .force_bytes = microcontroller_force_bytes,
          .byte_rate = serial_rate(1.0, baud)};
}

DriveProblem fault_of(unsigned state) {
  return {DriveProblemCode::microcontroller_fault, {{"fault", static_cast<double>(state)}}};
}

}  // namespace

std::uint16_t MicrocontrollerDriver::next_sequence() noexcept {
  return static_cast<std::uint16_t>(sequence_.fetch_add(1, std::memory_order_relaxed) + 1);
}

std::optional<std::string_view> MicrocontrollerDriver::next_frame() noexcept {
  const std::size_t end = input_.bytes().find('\0');
  if (end == std::string_view::npos) return std::nullopt;
  return input_.take(end + 1);
}

template <typename Decode>
auto MicrocontrollerDriver::answer(MicrocontrollerCommand command, Decode decode, std::int64_t patience) noexcept {
  const std::uint16_t sequence = next_sequence();
  const std::int64_t until = clock_now() + patience;
  port_.write(microcontroller_frame(command, sequence).view());
  decltype(decode(std::string_view())) found;
  do {
    for (auto frame = next_frame(); frame; frame = next_frame()) {
      found = decode(*frame);
      if (found && found->sequence == sequence) return found;
    }
  } while (fill(until));
  found.reset();  // those that came were to older ones
  return found;
}

MicrocontrollerDriver::MicrocontrollerDriver(const SerialLink& link)
    : facts_(facts_of(link)),
      sign_(link.drive.sign),
      force_sign_(link.drive.sign * link.drive.force_sign),
      port_(link.port, baud_of(link)),
      patience_(link.lock_step ? lock_step_patience
                               : std::llround(1e9 * serial_share_of_cycle * link.sampling_period)) {
  for (int i = 0; i < tries_while_booting; ++i) {
    port_.write(frame_end);  // of what another program wrote
    const std::int64_t begin = clock_now();
    const auto found = answer(MicrocontrollerCommand::description, microcontroller_description, booting_patience);
    if (!found) {
      sleep_until(begin + booting_patience);  // a port that is gone answers at once
      continue;
    }
    require_usable(*found, link.sampling_period);
    facts_.watchdog = found->watchdog;
    facts_.settings.force_limit = found->force_limit;
    return;
  }
  throw DriverFailed(DriveProblemCode::silent_microcontroller);
}

void MicrocontrollerDriver::require_usable(const MicrocontrollerDescription& found, double sampling_period) const {
  if (found.version != known_version) {
    throw DriverFailed(DriveProblemCode::sketch_version, {{"version", static_cast<double>(found.version)},
                                                          {"known", static_cast<double>(known_version)}});
  }
  if (!(found.force_limit > 0.0)) throw DriverFailed(DriveProblemCode::sketch_force_limit);
  if (found.state >= MicrocontrollerState::first_fault) throw DriverFailed(fault_of(found.state));
  const double shortest = facts_.lock_step ? 0.0 : cycles_within_watchdog * sampling_period;
  if (found.watchdog >= shortest && found.watchdog <= longest_watchdog) return;
  throw DriverFailed(DriveProblemCode::sketch_watchdog,
                     {{"watchdog", found.watchdog}, {"least", shortest}, {"most", longest_watchdog}});
}

template <typename Decode>
auto MicrocontrollerDriver::ask_until_answered(MicrocontrollerCommand command, Decode decode) {
  for (int i = 0; i < setup_tries; ++i) {
    const std::int64_t begin = clock_now();
    if (const auto found = answer(command, decode, setup_patience)) return *found;
    sleep_until(begin + setup_patience);  // a port that is gone answers at once
  }
  throw DriverFailed(DriveProblemCode::silent_now);
}

MicrocontrollerDescription MicrocontrollerDriver::description() {
  return ask_until_answered(MicrocontrollerCommand::description, microcontroller_description);
}

void MicrocontrollerDriver::arm() {
  const auto found = ask_until_answered(MicrocontrollerCommand::hold, microcontroller_answer);
  if (found.state >= MicrocontrollerState::first_fault) throw DriverFailed(fault_of(found.state));
  if (found.state != MicrocontrollerState::holding) throw DriverFailed(DriveProblemCode::microcontroller_idle);
  is_armed_ = true;
}

std::optional<double> MicrocontrollerDriver::measure() noexcept {
  const auto found = answer(MicrocontrollerCommand::question, microcontroller_answer, patience_);
  if (!found) return std::nullopt;
  // What the loop sends then moves nothing. (A simulation in lock step waits for no clock, nor does its watchdog matter.)
  const bool has_fault = found->state >= MicrocontrollerState::first_fault;
  const bool has_let_go = !facts_.lock_step && is_armed_ && found->state != MicrocontrollerState::holding;
  trouble_ = !is_disarmed() && (has_fault || has_let_go) ? found->state : MicrocontrollerState::holding;
  if (trouble_ != MicrocontrollerState::holding) return std::nullopt;
  return sign_ * found->position;
}

std::optional<DriveProblem> MicrocontrollerDriver::trouble() const {
  if (trouble_ == MicrocontrollerState::holding) return std::nullopt;
  if (trouble_ >= MicrocontrollerState::first_fault) return fault_of(trouble_);
  const bool is_watchdog = trouble_ == MicrocontrollerState::let_go;
  return DriveProblem{is_watchdog ? DriveProblemCode::microcontroller_let_go
                                  : DriveProblemCode::microcontroller_not_held};
}

void MicrocontrollerDriver::send(double force) noexcept {
  port_.write(microcontroller_force(force_sign_ * force, next_sequence()).view());
}

void MicrocontrollerDriver::send_idle() noexcept {
  port_.drop_unsent();
  port_.write(frame_end);  // perhaps in the middle of a frame
  for (int i = 0; i < idle_frames; ++i) {
    port_.write(microcontroller_frame(MicrocontrollerCommand::release, next_sequence()).view());
  }
}

std::optional<bool> MicrocontrollerDriver::proves_watchdog() {
  for (int i = 0; i < proofs; ++i) {
    const MicrocontrollerDescription before = description();
    arm();
    sleep_until(clock_now() + std::llround(1e9 * silence_over_watchdog * before.watchdog));
    const MicrocontrollerDescription after = description();
    is_armed_ = false;
    const unsigned times = (after.times_let_go - before.times_let_go) & 0xffffU;
    if (after.state == MicrocontrollerState::let_go && times == 1) {
      facts_.watchdog = std::max(after.watchdog, after.silence);
      return true;
    }
  }
  facts_.watchdog.reset();
  return false;
}

}  // namespace zwidth::rig
