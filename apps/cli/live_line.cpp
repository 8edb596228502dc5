#include "cli/live_line.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "cli/standard_output.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::cli {
namespace {

constexpr std::chrono::seconds between_plain_lines{5};
constexpr std::string_view back_and_wipe = "\r\x1b[K";
constexpr std::size_t columns_of_most = 80;
constexpr std::size_t narrowest = 20;

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool is_terminal() {
  const char* name = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && name != nullptr && std::string_view(name) != "dumb";
}

/// One less than the terminal has: a line that fills the last one moves on to the next.
std::size_t columns() {
  winsize window{};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
  return std::max<std::size_t>(is_known ? window.ws_col : columns_of_most, narrowest) - 1;
}

/// With three digits: what moves needs no more.
std::string brief(double value, std::string_view unit) {
  return quantity(std::strtod(fmt::format("{:.2e}", value).c_str(), nullptr), unit);
}

/// "12.3 s  K 4000 B 5  F -1.24 N  x 802 µm  6.14 Hz 310 µm -0.52/s  worst 84.1 µs", in fields of one width each, so that
/// nothing jumps.
std::string text_of(const rig::LiveState& state, const Units& units) {
  std::string text = fmt::format("{:.1f} s", state.time);
  if (state.stiffness > 0.0) text += fmt::format("  K {:.4g} B {:.3g}", state.stiffness, state.damping);
  text += fmt::format("  F {:>8}  x {:>8}", brief(state.force, units.force), brief(state.position, units.length));
  if (state.swing.amplitude > 0.0) {
    text += fmt::format("  {:.3g} Hz {:>7} {:+.2f}/s", hertz(state.swing.frequency),
                        brief(state.swing.amplitude, units.length), state.swing.growth_rate);
  }
  return text + fmt::format("  worst {}", brief(state.worst, "s"));
}

}  // namespace

LiveLine::LiveLine(Units units, bool has_clock)
    : units_(units),
      has_clock_(has_clock),
      terminal_(is_terminal()),
      coloured_(terminal_ && !is_set("NO_COLOR")),
      next_(std::chrono::steady_clock::now()) {
  if (!terminal_) next_ += between_plain_lines;
}

LiveLine::~LiveLine() { wipe(); }

void LiveLine::wipe() {
  if (std::exchange(shown_, false)) write_standard_error(back_and_wipe);
}

void LiveLine::show(const rig::LiveState& state) {
  const std::string text = text_of(state, units_);
  if (!terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (!has_clock_ || now < next_) return;
    next_ = now + between_plain_lines;
    return write_standard_error(text + "\n");
  }
  const std::string line = report::shortened(text, columns());
  const bool grows = coloured_ && state.swing.amplitude > 0.0 && state.swing.growth_rate > 0.0;
  write_standard_error(fmt::format("{}{}{}{}", back_and_wipe, grows ? "\x1b[33m" : "", line, grows ? "\x1b[0m" : ""));
  shown_ = true;
}

}  // namespace zwidth::cli
