#include "io/column_unit.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <string>
#include <utility>

#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "io/unit_system.hpp"

namespace zwidth::internal {
using namespace std::string_view_literals;
namespace {

struct Unit {
  std::string_view name;
  double scale = 1.0;  ///< seconds per unit
};

constexpr std::array times{
    Unit{"s", 1.0},        Unit{"sec", 1.0},      Unit{"secs", 1.0},          Unit{"second", 1.0},
    Unit{"seconds", 1.0},  Unit{"ms", 1e-3},      Unit{"msec", 1e-3},         Unit{"us", 1e-6},
    Unit{"\u00b5s", 1e-6}, Unit{"\u03bcs", 1e-6}, Unit{"usec", 1e-6},         Unit{"ns", 1e-9},
    Unit{"millis", 1e-3},  Unit{"micros", 1e-6},  Unit{"milliseconds", 1e-3}, Unit{"microseconds", 1e-6},
    Unit{"min", 60.0}};

/// Beside the times, in a row of units.
constexpr std::array others{
    "m"sv,     "cm"sv,   "mm"sv,        "um"sv,      "\u00b5m"sv, "\u03bcm"sv,  "nm"sv,    "in"sv,    "rad"sv,
    "mrad"sv,  "deg"sv,  "\u00b0"sv,    "degrees"sv, "rev"sv,     "turn"sv,     "turns"sv, "N"sv,     "mN"sv,
    "kN"sv,    "N m"sv,  "Nm"sv,        "N*m"sv,     "N.m"sv,     "N\u00b7m"sv, "mNm"sv,   "mN m"sv,  "A"sv,
    "mA"sv,    "V"sv,    "mV"sv,        "kV"sv,      "m/s"sv,     "mm/s"sv,     "rad/s"sv, "deg/s"sv, "\u00b0/s"sv,
    "m/s^2"sv, "m/s2"sv, "m/s\u00b2"sv, "mm/s^2"sv,  "rad/s^2"sv, "rad/s2"sv,   "g"sv,     "Hz"sv,    "kHz"sv,
    "%"sv,     "-"sv,    "1"sv,         "counts"sv,  "bit"sv,     "dB"sv};

/// How units are written that the unit system does not know.
struct Spelling {
  std::string_view written;
  const char* unit;  ///< null: known to be one, but of what only the user knows
};
constexpr Spelling spellings[] = {
    {"Ncm", "cN m"},       {"N-m", "N m"},        {"N-mm", "Nmm"},       {"N-cm", "cN m"},    {"mN-m", "mNm"},
    {"gf", "kgf/1000"},    {"ozin", "ozf in"},    {"oz-in", "ozf in"},   {"oz in", "ozf in"}, {"lbin", "lbf in"},
    {"lb-in", "lbf in"},   {"lb in", "lbf in"},   {"in-lb", "lbf in"},   {"lbft", "lbf ft"},  {"lb-ft", "lbf ft"},
    {"lb ft", "lbf ft"},   {"ft-lb", "lbf ft"},   {"ft-lbs", "lbf ft"},  {"mils", "in/1000"}, {"microns", "micron"},
    {"millimeters", "mm"}, {"millimetres", "mm"}, {"centimeters", "cm"}, {"radians", "rad"},  {"newtons", "N"},
    {"\u00b0", "deg"},     {"\u00b0/s", "deg/s"}, {"m/s2", "m/s^2"},     {"mm/s2", "mm/s^2"}, {"rad/s2", "rad/s^2"},
    {"deg/s2", "deg/s^2"}, {"g", nullptr},        {"lb", nullptr},       {"lbs", nullptr},    {"oz", nullptr},
    {"kg", nullptr},       {"gcm", nullptr},      {"kgcm", nullptr},     {"cnt", nullptr},    {"lsb", nullptr},
    {"LSB", nullptr},      {"bits", nullptr},     {"percent", nullptr},  {"amps", nullptr},   {"volts", nullptr}};

/// At the end of a name, where "force_in", "x_m" or "channel_A" would say something else.
constexpr std::array clear_ends{
    "mm"sv,       "cm"sv,      "um"sv,      "\u00b5m"sv, "\u03bcm"sv, "mrad"sv,   "urad"sv,      "rad"sv,    "deg"sv,
    "degrees"sv,  "\u00b0"sv,  "rev"sv,     "turn"sv,    "turns"sv,   "arcmin"sv, "inch"sv,      "inches"sv, "mils"sv,
    "micron"sv,   "microns"sv, "N"sv,       "uN"sv,      "mN"sv,      "cN"sv,     "kN"sv,        "Nm"sv,     "uNm"sv,
    "mNm"sv,      "kNm"sv,     "Nmm"sv,     "Ncm"sv,     "N-m"sv,     "N mm"sv,   "N m"sv,       "gf"sv,     "kgf"sv,
    "lbf"sv,      "ozf"sv,     "ozin"sv,    "oz-in"sv,   "lbin"sv,    "lb-in"sv,  "lbft"sv,      "lb-ft"sv,  "ft-lb"sv,
    "lb"sv,       "lbs"sv,     "oz"sv,      "kg"sv,      "gcm"sv,     "kgcm"sv,   "mA"sv,        "mV"sv,     "amps"sv,
    "volts"sv,    "counts"sv,  "count"sv,   "ticks"sv,   "cnt"sv,     "lsb"sv,    "LSB"sv,       "bits"sv,   "%"sv,
    "percent"sv,  "m/s"sv,     "mm/s"sv,    "rad/s"sv,   "deg/s"sv,   "rpm"sv,    "m/s2"sv,      "m/s^2"sv,  "mm/s2"sv,
    "mm/s^2"sv,   "rad/s2"sv,  "rad/s^2"sv, "mN m"sv,    "mN.m"sv,    "mN*m"sv,   "mN\u00b7m"sv, "N.m"sv,    "N*m"sv,
    "N\u00b7m"sv, "kN m"sv,    "cN m"sv,    "ozf in"sv,  "lbf in"sv,  "lbf ft"sv, "kgf cm"sv,    "kgf m"sv,  "gf cm"sv,
    "mdeg"sv,     "rot"sv,     "dyn"sv,     "nN"sv,      "pN"sv};

std::string_view without_brackets(std::string_view word) {
  word = trimmed(word);
  const bool bracketed =
      word.size() > 2 && ((word.front() == '[' && word.back() == ']') || (word.front() == '(' && word.back() == ')'));
  return bracketed ? trimmed(word.substr(1, word.size() - 2)) : word;
}

const Unit* find_time(std::string_view word) {
  const auto* const found = std::ranges::find(times, word, &Unit::name);
  return found == times.end() ? nullptr : found;
}

bool contains(std::string_view lower_name, std::initializer_list<std::string_view> parts) {
  return std::ranges::any_of(parts,
                             [&](std::string_view part) { return lower_name.find(part) != std::string_view::npos; });
}

/// The unit by what the unit system takes it for; other where it takes it for none.
ColumnUnit known_unit(std::string_view text) {
  ColumnUnit result{text, StatedQuantity::other};
  std::string_view word = text;
  if (word.starts_with("in ")) word = trimmed(word.substr(3));
  std::string unit(word);
  std::ranges::replace(unit, '_', ' ');
  if (const auto* const spelt = std::ranges::find(spellings, unit, &Spelling::written); spelt != std::end(spellings)) {
    if (spelt->unit == nullptr) return result;
    unit = spelt->unit;
  }
  auto ascii = ascii_unit(unit);
  if (ascii && !is_unit(*ascii)) std::erase(*ascii, '-');  // "milli-newton"
  if (!ascii) return result;
  using enum StatedQuantity;
  constexpr std::pair<const char*, StatedQuantity> quantities[] = {
      {"N", force},        {"N m", force},          {"m", position},           {"rad", position}, {"m/s", velocity},
      {"rad/s", velocity}, {"m/s^2", acceleration}, {"rad/s^2", acceleration}, {"A", other},      {"V", other}};
  for (const auto& [si, quantity] : quantities) {
    const auto factor = unit_factor(*ascii, si);
    if (factor) return {text, quantity, si, static_cast<double>(*factor)};
  }
  return result;
}

ColumnUnit unit_in_brackets(std::string_view name) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}, std::pair{'{', '}'}}) {
    for (std::size_t begin = name.find(open); begin != std::string_view::npos; begin = name.find(open, begin + 1)) {
      const std::size_t end = name.find(close, begin);
      if (begin == 0) break;
      if (end == std::string_view::npos) {  // "force [N"
        const std::string_view rest = trimmed(name.substr(begin + 1));
        return open == '[' && !rest.empty() ? ColumnUnit{rest, StatedQuantity::other} : ColumnUnit{};
      }
      const std::string_view text = trimmed(name.substr(begin + 1, end - begin - 1));
      const bool is_index = std::ranges::all_of(text, [](char c) { return (c >= '0' && c <= '9') || c == ','; });
      if (is_index) continue;  // "q[0]"
      const ColumnUnit unit = known_unit(text);
      const bool is_spelt = std::ranges::find(spellings, text, &Spelling::written) != std::end(spellings);
      const bool is_known = unit.quantity != StatedQuantity::other || unit.factor != 1.0 || is_spelt || is_unit(text);
      if (is_known || open == '[') return unit;  // "(filtered)" is none
    }
  }
  return {};
}

ColumnUnit unit_at_end(std::string_view name) {
  const std::string lower = lower_case(name);
  for (std::size_t begin = 0; begin < name.size(); ++begin) {
    if (begin > 0 && std::string_view("_ .:,/").find(name[begin - 1]) == std::string_view::npos) continue;
    const std::string_view end = name.substr(begin);
    if (end == "nm") {  // a torque in lower case, or nanometres
      const bool is_torque = contains(lower, {"torq", "tau", "mom", "force"});
      return is_torque ? ColumnUnit{end, StatedQuantity::force, "N m", 1.0}
                       : ColumnUnit{end, StatedQuantity::position, "m", 1e-9};
    }
    const bool is_electric = (end == "A" || end == "V") && contains(lower, {"cur", "amp", "volt", "cmd", "command"});
    std::string word(end);
    std::ranges::replace(word, '_', ' ');
    if (is_electric || std::ranges::find(clear_ends, word) != clear_ends.end()) return known_unit(end);
  }
  return {};
}

/// "x_mm_rel": perhaps a unit, perhaps a word that looks like one. Nothing of what is no unit of its own elsewhere.
ColumnUnit unit_in_the_middle(std::string_view name) {
  constexpr std::array plain{"mm"sv, "cm"sv, "um"sv,  "mrad"sv, "deg"sv,   "degrees"sv,
                             "mN"sv, "kN"sv, "mNm"sv, "Nmm"sv,  "counts"sv};
  constexpr std::string_view separators = "_ .:,/";
  for (std::size_t begin = 0; begin < name.size();) {
    const std::size_t end = std::min(name.find_first_of(separators, begin), name.size());
    const std::string_view word = name.substr(begin, end - begin);
    if (begin > 0 && end < name.size() && std::ranges::find(plain, word) != plain.end()) {
      return {word, StatedQuantity::other};
    }
    begin = end + 1;
  }
  return {};
}

}  // namespace

bool is_unit(std::string_view word) {
  const std::string_view unit = without_brackets(word);
  return find_time(unit) != nullptr || std::ranges::find(others, unit) != others.end();
}

std::optional<double> seconds_per(std::string_view unit) {
  const Unit* found = find_time(without_brackets(unit));
  return found == nullptr ? std::nullopt : std::optional(found->scale);
}

ColumnUnit unit_of_column(std::string_view name) {
  const ColumnUnit in_brackets = unit_in_brackets(name);
  if (!in_brackets.text.empty()) return in_brackets;
  const ColumnUnit at_end = unit_at_end(trimmed(name));
  return at_end.text.empty() ? unit_in_the_middle(name) : at_end;
}

}  // namespace zwidth::internal
