#include "io/column_unit.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "io/number_cell.hpp"

namespace zwidth::internal {
using namespace std::string_view_literals;
namespace {

struct Unit {
  std::string_view name;
  double scale = 1.0;  ///< base units per unit
};

constexpr std::array times{
    Unit{"s", 1.0},        Unit{"sec", 1.0},      Unit{"secs", 1.0},          Unit{"second", 1.0},
    Unit{"seconds", 1.0},  Unit{"ms", 1e-3},      Unit{"msec", 1e-3},         Unit{"us", 1e-6},
    Unit{"\u00b5s", 1e-6}, Unit{"\u03bcs", 1e-6}, Unit{"usec", 1e-6},         Unit{"ns", 1e-9},
    Unit{"millis", 1e-3},  Unit{"micros", 1e-6},  Unit{"milliseconds", 1e-3}, Unit{"microseconds", 1e-6},
    Unit{"min", 60.0}};

constexpr double degree = std::numbers::pi / 180.0;
constexpr std::array others{Unit{"m"},
                            Unit{"cm", 1e-2},
                            Unit{"mm", 1e-3},
                            Unit{"um", 1e-6},
                            Unit{"\u00b5m", 1e-6},
                            Unit{"\u03bcm", 1e-6},
                            Unit{"nm", 1e-9},
                            Unit{"in", 0.0254},
                            Unit{"rad"},
                            Unit{"mrad", 1e-3},
                            Unit{"deg", degree},
                            Unit{"\u00b0", degree},
                            Unit{"degrees", degree},
                            Unit{"rev", 360.0 * degree},
                            Unit{"turn", 360.0 * degree},
                            Unit{"turns", 360.0 * degree},
                            Unit{"N"},
                            Unit{"mN", 1e-3},
                            Unit{"kN", 1e3},
                            Unit{"N m"},
                            Unit{"Nm"},
                            Unit{"N*m"},
                            Unit{"N.m"},
                            Unit{"N\u00b7m"},
                            Unit{"mNm", 1e-3},
                            Unit{"mN m", 1e-3},
                            Unit{"A"},
                            Unit{"mA", 1e-3},
                            Unit{"V"},
                            Unit{"mV", 1e-3},
                            Unit{"kV", 1e3},
                            Unit{"m/s"},
                            Unit{"mm/s", 1e-3},
                            Unit{"rad/s"},
                            Unit{"deg/s", degree},
                            Unit{"\u00b0/s", degree},
                            Unit{"m/s^2"},
                            Unit{"m/s2"},
                            Unit{"m/s\u00b2"},
                            Unit{"mm/s^2", 1e-3},
                            Unit{"rad/s^2"},
                            Unit{"rad/s2"},
                            Unit{"g", 9.80665},
                            Unit{"Hz"},
                            Unit{"kHz", 1e3},
                            Unit{"%", 1e-2},
                            Unit{"-"},
                            Unit{"1"},
                            Unit{"counts"},
                            Unit{"bit"},
                            Unit{"dB"}};

std::string_view without_brackets(std::string_view word) {
  word = trimmed(word);
  const bool bracketed =
      word.size() > 2 && ((word.front() == '[' && word.back() == ']') || (word.front() == '(' && word.back() == ')'));
  return bracketed ? trimmed(word.substr(1, word.size() - 2)) : word;
}

template <std::size_t Size>
const Unit* find_unit(const std::array<Unit, Size>& units, std::string_view word) {
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return unit.name == word; });
  return found == units.end() ? nullptr : &*found;
}

}  // namespace

bool is_unit(std::string_view word) {
  const std::string_view unit = without_brackets(word);
  return find_unit(times, unit) != nullptr || find_unit(others, unit) != nullptr;
}

std::optional<double> seconds_per(std::string_view unit) {
  const Unit* found = find_unit(times, without_brackets(unit));
  return found == nullptr ? std::nullopt : std::optional(found->scale);
}

std::string_view unit_at_end(std::string_view name) {
  // Those that could be part of a name ("force_in", "torque_nm") are none.
  constexpr std::array clear{"mm"sv,  "cm"sv,   "um"sv,    "mrad"sv, "deg"sv, "degrees"sv,
                             "rev"sv, "turn"sv, "turns"sv, "mN"sv,   "kN"sv,  "mNm"sv};
  const std::size_t begin = name.find_last_of("_ .");
  if (begin == std::string_view::npos || begin == 0) return {};
  const std::string_view end = name.substr(begin + 1);
  return std::find(clear.begin(), clear.end(), end) == clear.end() ? std::string_view() : end;
}

std::optional<double> base_units_per(std::string_view unit) {
  const Unit* found = find_unit(others, without_brackets(unit));
  return found == nullptr || found->scale == 1.0 ? std::nullopt : std::optional(found->scale);
}

}  // namespace zwidth::internal
