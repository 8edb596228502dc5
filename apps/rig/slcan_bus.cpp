#include "rig/slcan_bus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "rig/can_text.hpp"
#include "rig/driver.hpp"
#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

constexpr std::int64_t telling_patience = 250'000'000;  // ns, for what the adapter is
constexpr std::int64_t answer_patience = 30'000'000;    // for its answer to a command, where it gives any
constexpr std::int64_t leaving_time = 20'000'000;       // for what was sent last, on the slowest bus
constexpr std::string_view line_ends = "\r\a";
constexpr char bell = '\a';  // SLCAN's error
constexpr double fdcanusb_rate = 1e6;

// Of S7 adapters differ: 800 kbit/s at Lawicel's, 750 at CANable's.
constexpr std::array<std::pair<int, char>, 8> rates_of_slcan{{{10'000, '0'},
                                                              {20'000, '1'},
                                                              {50'000, '2'},
                                                              {100'000, '3'},
                                                              {125'000, '4'},
                                                              {250'000, '5'},
                                                              {500'000, '6'},
                                                              {1'000'000, '8'}}};
constexpr std::array<std::pair<int, char>, 2> data_rates_of_slcan{{{2'000'000, '2'}, {5'000'000, '5'}}};

template <std::size_t size>
char code_of(double rate, const std::array<std::pair<int, char>, size>& codes) {
  for (const auto& [each, code] : codes) {
    if (static_cast<double>(each) == rate) return code;
  }
  std::vector<int> all;
  for (const auto& [each, code] : codes) all.push_back(each);
  throw DriverFailed(DriveProblemCode::bit_rate_unknown, {{"rate", rate}},
                     {{"known", fmt::format("{}", fmt::join(all, ", "))}});
}

}  // namespace

SlcanBus::SlcanBus(const CanAdapter& adapter, const CanBitRates& rates)
    : port_(adapter.place, adapter.baud.value_or(0), '\r') {
  is_fdcanusb_ = is_fdcanusb();
  if (is_fdcanusb_) {
    open_fdcanusb(rates);
  } else {
    open_slcan(rates);
  }
  input_.forget();
}

SlcanBus::~SlcanBus() {
  sleep_until(clock_now() + leaving_time);  // closed at once, an adapter drops the frames that let the drive go
  if (!is_fdcanusb_) {
    port_.write("C\r");
  } else if (has_changed_rate_) {
    for (const std::string_view command : {"can off\n", "conf load\n", "can on\n"}) port_.write(command);
  }
}

bool SlcanBus::is_fdcanusb() {
  // Twice: the first may end what another program left half written.
  for (const std::string_view command : {"C\r", "C\r", "V\r"}) port_.write(command);
  const std::int64_t until = clock_now() + telling_patience;
  std::string said;
  while (input_.fill(port_, until)) {
    said += input_.take(input_.bytes().size());
    if (said.find("ERR") != std::string::npos) return true;
    if (said.find("V") != std::string::npos && line_ends.find(said.back()) != std::string_view::npos) return false;
  }
  return false;
}

SlcanBus::Answer SlcanBus::told(std::string_view command) {
  input_.forget();
  if (!port_.write(command)) throw DriverFailed(DriveProblemCode::adapter_full);
  const std::int64_t until = clock_now() + answer_patience;
  std::string said;
  while (input_.fill(port_, until)) {
    said += input_.take(input_.bytes().size());
    if (said.find(bell) != std::string::npos || said.find("ERR") != std::string::npos) return Answer::refused;
    if (!is_fdcanusb_ && said.find('\r') != std::string::npos) return Answer::taken;
    if (said.find("OK") != std::string::npos) return Answer::taken;
  }
  return Answer::none;
}

void SlcanBus::open_fdcanusb(const CanBitRates& rates) {
  if (rates.nominal != fdcanusb_rate) {
    (void)told("can off\n");
    if (told(fmt::format("conf set can.bitrate {:.0f}\n", rates.nominal)) != Answer::taken) {
      throw DriverFailed(DriveProblemCode::bit_rate_refused_fdcanusb, {{"rate", rates.nominal}});
    }
    has_changed_rate_ = true;
  }
  (void)told("can on\n");  // an error where it was on
}

void SlcanBus::open_slcan(const CanBitRates& rates) {
  const auto require = [&](const std::string& command, DriveProblemCode otherwise) {
    if (told(command) != Answer::refused) return;
    throw DriverFailed(otherwise, {}, {{"command", command.substr(0, command.size() - 1)}});
  };
  const char nominal = code_of(rates.nominal, rates_of_slcan);
  const char data = rates.data > 0.0 ? code_of(rates.data, data_rates_of_slcan) : '\0';
  require(fmt::format("S{}\r", nominal), DriveProblemCode::bit_rate_refused);
  if (data != '\0') require(fmt::format("Y{}\r", data), DriveProblemCode::adapter_without_can_fd);
  require("O\r", DriveProblemCode::channel_not_opened);
}

bool SlcanBus::send(const CanFrame& frame) noexcept {
  return port_.write((is_fdcanusb_ ? fdcanusb_line(frame) : slcan_line(frame)).view());
}

std::optional<CanFrame> SlcanBus::receive(std::int64_t until) noexcept {
  do {
    for (;;) {
      const std::string_view bytes = input_.bytes();
      const std::size_t end = is_fdcanusb_ ? bytes.find('\n') : bytes.find_first_of(line_ends);
      if (end == std::string_view::npos) break;
      const std::string_view line = input_.take(end + 1).substr(0, end);
      if (const auto frame = is_fdcanusb_ ? fdcanusb_frame(line) : slcan_frame(line)) return frame;
    }
  } while (input_.fill(port_, until));
  is_gone_ = input_.has_failed();
  return std::nullopt;
}

}  // namespace zwidth::rig
