#include "cli/live_line.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/standard_output.hpp"
#include "report/text/text_medium.hpp"
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

/// What stands in a line, the first to stay where it is narrow.
struct Field {
  std::string text;
  int rank = 0;  ///< the greater, the sooner it is left out
};

/// The fields in their order; those of the highest rank left out, one after the other, until the rest has so many columns at
/// most: a number keeps its unit.
std::string fitted(std::vector<Field> fields, std::size_t columns) {
  const auto joined = [&] {
    std::string line;
    for (const Field& each : fields) line += (line.empty() ? "" : "  ") + each.text;
    return line;
  };
  const auto later = [](const Field& one, const Field& other) { return one.rank < other.rank; };
  while (fields.size() > 1 && report::width_of(joined()) > columns)
    fields.erase(std::ranges::max_element(fields, later));
  return joined();
}

/// "12.3 s  K 4 kN/m  B 5 N s/m  F -1.24 N  x 802 µm  6.14 Hz 310 µm -0.52/s  worst 84.1 µs", force and position in fields of
/// one width each, so that nothing jumps.
std::vector<Field> fields_of(const rig::LiveState& state, const Units& units) {
  std::vector<Field> fields{{fmt::format("{:.1f} s", state.time), 2}};
  if (state.stiffness > 0.0) {
    fields.push_back({fmt::format("K {}", brief(state.stiffness, units.stiffness)), 4});
    fields.push_back({fmt::format("B {:.3g} {}", state.damping, units.damping), 5});
  }
  fields.push_back({fmt::format("F {:>8}", brief(state.force, units.force)), 0});
  fields.push_back({fmt::format("x {:>8}", brief(state.position, units.length)), 1});
  if (state.swing.amplitude > 0.0) {
    fields.push_back({fmt::format("{:.3g} Hz {:>7} {:+.2f}/s", hertz(state.swing.frequency),
                                  brief(state.swing.amplitude, units.length), state.swing.growth_rate),
                      3});
  }
  fields.push_back({fmt::format("worst {}", brief(state.worst, "s")), 6});
  return fields;
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
  if (!terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (!has_clock_ || now < next_) return;
    next_ = now + between_plain_lines;
    return write_standard_error(fitted(fields_of(state, units_), report::no_line_end) + "\n");
  }
  const std::string line = fitted(fields_of(state, units_), columns());
  const bool grows = coloured_ && state.swing.amplitude > 0.0 && state.swing.growth_rate > 0.0;
  write_standard_error(fmt::format("{}{}{}{}", back_and_wipe, grows ? "\x1b[33m" : "", line, grows ? "\x1b[0m" : ""));
  shown_ = true;
}

}  // namespace zwidth::cli
