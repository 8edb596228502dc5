#include "rig/serial_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rig/real_time.hpp"
#include "rig/serial_port.hpp"
#include "zwidth/rig/force_guard.hpp"
#include "zwidth/rig/serial_rate.hpp"

namespace zwidth::rig {
namespace {

constexpr double expiry_before_last = 1.5;  // cycles: between the last two that may be missed, whatever the clock does
constexpr double printed_step = 1e-6;       // of drives that print six decimals
constexpr double printed_share = 1e-3;
constexpr double bits_of_byte = 10.0;  // with start and stop

int baud_of(const SerialLink& link, int otherwise) { return link.drive.baud.value_or(otherwise); }

/// Refuses what cannot work before a single byte goes out.
DriverFacts checked(DriverFacts facts, const SerialLink& link) {
  facts.lock_step = link.lock_step;
  if (!link.lock_step && facts.watchdog && *facts.watchdog < cycles_within_watchdog * link.sampling_period) {
    throw DriverFailed(DriveProblemCode::watchdog_below_cycle, {{"watchdog", *facts.watchdog},
                                                                {"period", link.sampling_period},
                                                                {"most", *facts.watchdog / cycles_within_watchdog}});
  }
  return facts;
}

}  // namespace

void require_fast_line(double bytes_per_cycle, double baud, double sampling_period) {
  if (const auto problem = find_problem(SerialLoad{bytes_per_cycle, baud, sampling_period})) {
    throw DriverFailed(DriveProblemCode::line_too_slow, problem->problem.value_or(Problem{}).evidence);
  }
}

DriverFacts on_serial_line(DriverFacts facts, const SerialLink& link, int otherwise) {
  const int baud = baud_of(link, otherwise);
  facts.byte_rate = serial_rate(1.0, baud);
  if (!link.lock_step) require_fast_line(facts.bytes_per_cycle, static_cast<double>(baud), link.sampling_period);
  return facts;
}

OpenPort serial_port_of(const SerialLink& link, int otherwise) {
  return [path = link.port, baud = baud_of(link, otherwise)] { return std::make_unique<SerialPort>(path, baud); };
}

SerialDriver::SerialDriver(DriverFacts facts, const SerialLink& link, const OpenPort& open)
    : facts_(checked(std::move(facts), link)),
      sampling_period_(link.sampling_period),
      drive_(link.drive),
      port_(open()),
      is_can_(link.is_can),
      patience_(link.lock_step ? lock_step_patience
                               : std::llround(1e9 * serial_share_of_cycle * link.sampling_period)) {
  allow_missed(allowed_missed_cycles(link.sampling_period));
}

std::size_t SerialDriver::frame_size(std::string_view bytes) const noexcept {
  const std::size_t end = bytes.find('\n');
  return end == std::string_view::npos ? 0 : end + 1;
}

std::string_view SerialDriver::next_frame() noexcept { return input_.take(frame_size(input_.bytes())); }

void SerialDriver::forget_input() noexcept {
  input_.forget();
  is_owed_ = false;
  marks_owed_ = 0;
  while (fill(0)) input_.forget();
}

void SerialDriver::allow_missed(unsigned cycles) noexcept {
  if (facts_.lock_step) return;  // its answers come, or never do
  expiry_ = std::llround(1e9 * (std::max(cycles, 2U) - expiry_before_last) * sampling_period_);
}

std::optional<SerialDriver::Heard> SerialDriver::answer(std::int64_t until) noexcept {
  do {
    for (std::string_view frame = next_frame(); !frame.empty(); frame = next_frame()) {
      const Heard heard = hear(frame);
      if (heard.meaning == Meaning::mark) marks_owed_ = std::max(0, marks_owed_ - 1);
      if (marks_owed_ == 0 && (heard.meaning == Meaning::position || heard.meaning == Meaning::broken)) return heard;
    }
  } while (fill(until));
  return std::nullopt;
}

std::optional<double> SerialDriver::measure() noexcept {
  while (answer(0)) is_owed_ = false;  // what came since the last cycle: echoes, and what was owed
  const std::int64_t until = clock_now() + patience_;
  if (is_owed_ && clock_now() - asked_ < expiry_) {
    if (!answer(until)) return std::nullopt;
    is_owed_ = false;
  }
  if (is_owed_) {  // it may be lost, or come yet
    if (!port_->write(mark().view())) return std::nullopt;
    ++marks_owed_;
  }
  is_owed_ = true;
  asked_ = clock_now();
  port_->write(question().view());
  const auto heard = answer(until);
  if (!heard) return std::nullopt;
  is_owed_ = false;
  last_ = *heard;
  if (heard->meaning != Meaning::position) return std::nullopt;
  return heard->turns * drive_.position_per_turn();
}

std::optional<DriveProblem> SerialDriver::trouble() const {
  if (last_.trouble == Trouble::none) return std::nullopt;
  return problem_of(last_.trouble, last_.code);
}

std::optional<std::string> SerialDriver::ask(std::string_view frame, const Understood& understood,
                                             std::int64_t patience) {
  forget_input();
  tell(frame);
  const std::int64_t until = clock_now() + patience;
  while (fill(until)) {
    for (std::string_view answer = next_frame(); !answer.empty(); answer = next_frame()) {
      if (auto text = understood(answer)) return text;
    }
  }
  return std::nullopt;
}

std::string SerialDriver::ask_until_answered(std::string_view frame, const Understood& understood, int tries) {
  const std::int64_t first = clock_now();
  for (int i = 0; i < tries; ++i) {
    const std::int64_t begin = clock_now();
    if (auto text = ask(frame, understood)) {
      // Those to the questions after the first may still come, and would be taken for answers to the next one.
      if (i > 0) sleep_until(clock_now() + (clock_now() - first));
      return *std::move(text);
    }
    sleep_until(begin + setup_patience);  // a port that is gone answers at once
  }
  throw DriverFailed(unanswered());
}

DriveProblem SerialDriver::unanswered() const {
  return {is_can_ ? DriveProblemCode::silent_on_bus : DriveProblemCode::silent};
}

void SerialDriver::set_damper(const Device& device, DriveFirmware firmware, std::optional<double> force_limit) {
  const double travel = std::abs(drive_.torque_per_force());  // per rad of the motor
  Damper& damper = damper_.emplace();
  damper.numbers = damper_numbers(device, firmware);
  damper.damping = device.parameters().wall.damping * travel * travel;
  if (force_limit) damper.torque_limit = *force_limit * travel;
}

void SerialDriver::require_taken(std::string_view name, double told, std::string_view said) {
  const auto number = as_number(said);
  if (number && std::abs(*number - told) <= printed_step + printed_share * std::abs(told)) return;
  throw DriverFailed(DriveProblemCode::damper_number_not_taken, {{"told", told}},
                     {{"name", std::string(name)}, {"said", std::string(said)}});
}

void SerialDriver::add_force_bytes(double bytes, double bus_time) {
  facts_.bytes_per_cycle += bytes;
  facts_.force_bytes += bytes;
  facts_.bus_time_per_cycle += bus_time;
  facts_.force_bus_time += bus_time;
  if (facts_.lock_step) return;
  if (!is_can_) {
    return require_fast_line(facts_.bytes_per_cycle, bits_of_byte * facts_.byte_rate.value_or(0.0), sampling_period_);
  }
  const double line = facts_.byte_rate ? facts_.bytes_per_cycle / *facts_.byte_rate : 0.0;
  const double needed = (line + facts_.bus_time_per_cycle) / serial_share_of_cycle;
  if (needed <= sampling_period_) return;
  throw DriverFailed(DriveProblemCode::too_slow_for_damper, {{"period", std::ceil(1e4 * needed) * 1e-4}});
}

void SerialDriver::set_torque_limit(double torque) noexcept {
  facts_.settings.force_limit = torque / std::abs(drive_.torque_per_force());
}

void SerialDriver::tell(std::string_view frame) {
  if (!port_->write(frame)) throw DriverFailed(DriveProblemCode::port_full);
}

}  // namespace zwidth::rig
