#include "zwidth/io/number_with_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "io/number_cell.hpp"
#include "io/toml_text.hpp"
#include "io/unit_system.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth {
using namespace internal;
namespace {

struct MeasuredUnit {
  std::string_view name;     ///< of what is measured
  std::string_view si;       ///< unit of a plain number
  std::string_view without;  ///< the same with the radian left out or written out; empty: there is no such form
  std::string_view example;
};

const MeasuredUnit& unit_of(Measure measure, Motion motion) {
  // In the order of Measure.
  static constexpr std::array<MeasuredUnit, 12> linear{{{"a ratio", "", "", "20 %"},
                                                        {"a time", "s", "", "1.5 ms"},
                                                        {"a frequency", "Hz", "", "0.2 kHz"},
                                                        {"an angular frequency", "rad/s", "", "40 Hz"},
                                                        {"a length", "m", "", "5 um"},
                                                        {"a force", "N", "", "500 mN"},
                                                        {"a mass", "kg", "", "220 g"},
                                                        {"a damping", "N s/m", "", "5 N s/m"},
                                                        {"a stiffness", "N/m", "", "5 N/mm"},
                                                        {"a velocity", "m/s", "", "50 mm/s"},
                                                        {"a torque constant", "N m/A", "", "50 mN m/A"},
                                                        {"a torque per voltage", "N m/V", "", "20 mN m/V"}}};
  static constexpr std::array<MeasuredUnit, 12> rotary{{linear[0],
                                                        linear[1],
                                                        linear[2],
                                                        linear[3],
                                                        {"an angle", "rad", "", "1 turn/4096"},
                                                        {"a torque", "N m", "N m/rad", "500 mN m"},
                                                        {"an inertia", "kg m^2", "kg m^2/rad", "22 kg cm^2"},
                                                        {"a damping", "N m s/rad", "N m s", "0.1 N m s/rad"},
                                                        {"a stiffness", "N m/rad", "N m", "0.4 N m/deg"},
                                                        {"an angular velocity", "rad/s", "", "90 deg/s"},
                                                        linear[10],
                                                        linear[11]}};
  return (motion == Motion::rotary ? rotary : linear)[static_cast<std::size_t>(measure)];
}

/// A number and the unit behind it.
struct Parts {
  double number = 0.0;
  std::string_view unit;
};

tl::expected<Parts, UnitProblem> parts_of(std::string_view text, const std::string& allowed) {
  const UnitProblem no_number{fmt::format("is the text {}", in_quotes(text)), allowed};
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  const std::size_t sign = rest.starts_with('-') ? 1 : 0;
  if (rest.size() == sign || std::string_view(".0123456789").find(rest[sign]) == std::string_view::npos) {
    return tl::unexpected(no_number);  // "inf" and "nan" too
  }
  Parts parts;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), parts.number);
  if (error == std::errc::result_out_of_range) {
    return tl::unexpected(UnitProblem{std::string(number_out_of_range), std::string(number_range)});
  }
  if (error != std::errc{}) return tl::unexpected(no_number);
  parts.unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  return parts;
}

/// number * factor; by division where the factor is one over a whole number, for that is the exact double: 400 us as
/// 400/1e6.
double scaled(double number, long double factor) {
  constexpr double largest_exact = 1e15;
  const long double inverse = std::round(1.0L / factor);
  constexpr double rounding = 4.0 * 2.220446049250313e-16;
  const bool is_division = factor < 1.0L && inverse < largest_exact && std::abs(inverse * factor - 1.0L) <= rounding;
  return is_division ? number / static_cast<double>(inverse) : static_cast<double>(number * factor);
}

std::optional<long double> factor_to(const std::string& unit, const MeasuredUnit& wanted) {
  if (const auto factor = unit_factor(unit, wanted.si.empty() ? "1" : std::string(wanted.si))) return factor;
  if (wanted.without.empty()) return std::nullopt;
  return unit_factor(unit, std::string(wanted.without));
}

/// A time that is given as its frequency, a step as counts per turn: the value to write instead.
std::optional<std::string> inverse_of(double number, const std::string& unit, Measure measure, Motion motion) {
  const double magnitude = std::abs(number);
  if (measure == Measure::time) {
    const auto factor = unit_factor(unit, "Hz");
    if (factor && magnitude > 0.0) {
      const auto rate = static_cast<double>(number * *factor);
      for (const auto& [unit_of_time, scale] : {std::pair{"ms", 1000.0}, std::pair{"us", 1e6}}) {
        const std::string brief = fmt::format("{:.6g}", scale / rate);
        double read = 0.0;
        std::from_chars(brief.data(), brief.data() + brief.size(), read);
        if (read >= 1e-3 && read / scale == 1.0 / rate) return fmt::format("{} {}", brief, unit_of_time);
      }
      return fmt::format("1 s/{:.10g}", rate);
    }
  }
  const std::string per = motion == Motion::rotary ? "rad^-1" : "m^-1";
  if (measure == Measure::position) {
    const auto factor = unit_factor(unit, per);
    if (factor && magnitude > 0.0) {
      const bool is_rotary = motion == Motion::rotary;
      const auto counts = static_cast<double>(number * *factor * (is_rotary ? 2.0 * std::numbers::pi : 1e-3));
      return fmt::format("1 {}/{:.10g}", is_rotary ? "turn" : "mm", counts);
    }
  }
  return std::nullopt;
}

/// A unit of the measure whose factors stand without a space between them, with it: "g cm2" of "gcm2". Nothing where two
/// readings differ.
std::optional<std::string> separated_unit(const std::string& unit, const MeasuredUnit& wanted) {
  constexpr std::size_t longest = 16;
  if (unit.size() > longest) return std::nullopt;
  std::optional<std::string> found;
  std::optional<long double> factor;
  bool is_one = true;
  const auto try_unit = [&](const std::string& candidate) {
    const auto own = factor_to(candidate, wanted);
    if (!own) return;
    is_one = is_one && own == factor.value_or(*own);
    if (!found) found = candidate, factor = own;
  };
  std::vector<std::size_t> gaps;  // between two letters
  const auto is_letter_at = [&](std::size_t at) { return std::isalpha(static_cast<unsigned char>(unit[at])) != 0; };
  for (std::size_t i = 1; i < unit.size(); ++i) {
    if (is_letter_at(i - 1) && is_letter_at(i)) gaps.push_back(i);
  }
  for (const std::size_t gap : gaps) try_unit(std::string(unit).insert(gap, " "));
  for (std::size_t i = 0; i < gaps.size() && !found; ++i) {
    for (std::size_t k = i + 1; k < gaps.size(); ++k) {
      try_unit(std::string(unit).insert(gaps[k], 1, ' ').insert(gaps[i], 1, ' '));
    }
  }
  return is_one ? found : std::nullopt;
}

}  // namespace

std::optional<std::string> with_decimal_point(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.find(',', comma + 1) != std::string_view::npos) return std::nullopt;
  const auto is_digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
  std::size_t begin = comma;
  while (begin > 0 && is_digit(begin - 1)) --begin;
  std::size_t end = comma + 1;
  while (is_digit(end)) ++end;
  const bool is_zero = text.substr(begin, comma - begin) == "0";
  if (begin == comma || end == comma + 1 || (end == comma + 4 && !is_zero)) return std::nullopt;
  std::string point(text);
  point[comma] = '.';
  return point;
}

std::string_view si_unit(Measure measure, Motion motion) { return unit_of(measure, motion).si; }

std::string allowed_numbers(Measure measure, Motion motion) {
  const MeasuredUnit& unit = unit_of(measure, motion);
  return fmt::format("must be a number{}{}, or a text with its unit such as \"{}\"", unit.si.empty() ? "" : " of ",
                     unit.si, unit.example);
}

tl::expected<double, UnitProblem> number_with_unit(std::string_view text, Measure measure, Motion motion) {
  const MeasuredUnit& wanted = unit_of(measure, motion);
  const std::string allowed = allowed_numbers(measure, motion);
  const auto parts = parts_of(text, allowed);
  if (!parts) return tl::unexpected(parts.error());
  if (parts->unit.empty()) return tl::unexpected(UnitProblem{fmt::format("{} has no unit", in_quotes(text)), allowed});
  if (parts->unit.front() == ',') {  // 0,01 or 1,000
    return tl::unexpected(UnitProblem{fmt::format("{} has a comma", in_quotes(text)),
                                      "the decimal mark is a point, and nothing stands between thousands",
                                      with_decimal_point(text)});
  }
  // A second number would multiply the first: "1 000 N/m" is refused.
  const bool begins_as_unit = std::string_view(".+-0123456789").find(parts->unit.front()) == std::string_view::npos;
  auto unit = begins_as_unit ? ascii_unit(parts->unit) : std::nullopt;
  if (unit && (unit->starts_with('/') || unit->starts_with('*'))) *unit = "1" + *unit;  // "1/4096 turn"
  if (!unit || !is_unit(*unit)) {
    const UnitProblem unknown{fmt::format("cannot read the unit {}", in_quotes(parts->unit)), allowed};
    const auto meant = unit ? separated_unit(*unit, wanted) : std::nullopt;
    if (!meant) return tl::unexpected(unknown);
    const auto number = trimmed(text.substr(0, static_cast<std::size_t>(parts->unit.data() - text.data())));
    const std::string value = fmt::format("{} {}", number, *meant);
    return tl::unexpected(UnitProblem{unknown.what, fmt::format("did you mean \"{}\"?", value), value});
  }
  const auto factor = factor_to(*unit, wanted);
  if (!factor) {
    const std::string what = fmt::format("{} is no unit of {}", in_quotes(parts->unit), wanted.name);
    const auto inverse = inverse_of(parts->number, *unit, measure, motion);
    if (!inverse) return tl::unexpected(UnitProblem{what, allowed});
    const bool is_time = measure == Measure::time;
    return tl::unexpected(UnitProblem{
        what, fmt::format("{}: \"{}\"", is_time ? "a period is 1/frequency" : "a step is its inverse", *inverse),
        inverse});
  }
  const double value = scaled(parts->number, *factor);
  if (!std::isfinite(value)) {
    return tl::unexpected(UnitProblem{std::string(number_out_of_range), std::string(number_range)});
  }
  return value;
}

}  // namespace zwidth
