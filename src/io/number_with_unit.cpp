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

#include "io/needed_value.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "io/unit_system.hpp"

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
  static constexpr std::array<MeasuredUnit, 12> linear{{{"ratio", "", "", "20 %"},
                                                        {"time", "s", "", "1.5 ms"},
                                                        {"frequency", "Hz", "", "0.2 kHz"},
                                                        {"angular frequency", "rad/s", "", "40 Hz"},
                                                        {"length", "m", "", "5 um"},
                                                        {"force", "N", "", "500 mN"},
                                                        {"mass", "kg", "", "220 g"},
                                                        {"damping", "N s/m", "", "5 N s/m"},
                                                        {"stiffness", "N/m", "", "5 N/mm"},
                                                        {"velocity", "m/s", "", "50 mm/s"},
                                                        {"torque constant", "N m/A", "", "50 mN m/A"},
                                                        {"torque per voltage", "N m/V", "", "20 mN m/V"}}};
  static constexpr std::array<MeasuredUnit, 12> rotary{{linear[0],
                                                        linear[1],
                                                        linear[2],
                                                        linear[3],
                                                        {"angle", "rad", "", "1 turn/4096"},
                                                        {"torque", "N m", "N m/rad", "500 mN m"},
                                                        {"inertia", "kg m^2", "kg m^2/rad", "22 kg cm^2"},
                                                        {"damping", "N m s/rad", "N m s", "0.1 N m s/rad"},
                                                        {"stiffness", "N m/rad", "N m", "0.4 N m/deg"},
                                                        {"angular velocity", "rad/s", "", "90 deg/s"},
                                                        linear[10],
                                                        linear[11]}};
  return (motion == Motion::rotary ? rotary : linear)[static_cast<std::size_t>(measure)];
}

/// A number and the unit behind it.
struct Parts {
  double number = 0.0;
  std::string_view unit;
};

UnitProblem unit_problem(Problem problem, std::optional<std::string> suggestion = std::nullopt) {
  OptionProblem told = option_problem("", std::move(problem));
  return {std::move(told.what), std::move(told.allowed), std::move(suggestion), std::move(told.problem)};
}

/// A problem whose sentence says what is needed, of a text that it shows.
UnitProblem unit_problem(ProblemCode code, const NeededValue& needed, std::string_view name, std::string_view shown) {
  Problem problem = needs(code, needed);
  problem.subjects.push_back({name, shortened(shown)});
  return unit_problem(std::move(problem));
}

tl::expected<Parts, UnitProblem> parts_of(std::string_view text, const NeededValue& needed) {
  const auto no_number = [&] { return unit_problem(ProblemCode::of_other_type, needed, "text", text); };
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  const std::size_t sign = rest.starts_with('-') ? 1 : 0;
  if (rest.size() == sign || std::string_view(".0123456789").find(rest[sign]) == std::string_view::npos) {
    return tl::unexpected(no_number());  // "inf" and "nan" too
  }
  Parts parts;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), parts.number);
  if (error == std::errc::result_out_of_range) {
    return tl::unexpected(unit_problem({.code = ProblemCode::number_beyond_range}));
  }
  if (error != std::errc{}) return tl::unexpected(no_number());
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

UnitProblem internal::comma_problem(std::string_view text) {
  std::optional<std::string> point = with_decimal_point(text);
  Problem problem{.code = ProblemCode::decimal_comma, .subjects = {{"text", shortened(text)}}};
  if (point) problem.subjects.push_back({"meant", *point});
  return unit_problem(std::move(problem), std::move(point));
}

std::string_view si_unit(Measure measure, Motion motion) { return unit_of(measure, motion).si; }

NeededValue internal::needed_number(Measure measure, Motion motion) {
  const MeasuredUnit& unit = unit_of(measure, motion);
  return {"measured", std::string(unit.example), std::string(unit.si)};
}

std::string allowed_numbers(Measure measure, Motion motion) {
  return option_problem("", needs(ProblemCode::of_other_type, needed_number(measure, motion))).allowed;
}

tl::expected<double, UnitProblem> number_with_unit(std::string_view text, Measure measure, Motion motion) {
  using enum ProblemCode;
  const MeasuredUnit& wanted = unit_of(measure, motion);
  const NeededValue needed = needed_number(measure, motion);
  const auto parts = parts_of(text, needed);
  if (!parts) return tl::unexpected(parts.error());
  if (parts->unit.empty()) return tl::unexpected(unit_problem(number_without_unit, needed, "text", text));
  if (parts->unit.front() == ',') return tl::unexpected(comma_problem(text));  // 0,01 or 1,000
  // A second number would multiply the first: "1 000 N/m" is refused.
  const bool begins_as_unit = std::string_view(".+-0123456789").find(parts->unit.front()) == std::string_view::npos;
  auto unit = begins_as_unit ? ascii_unit(parts->unit) : std::nullopt;
  if (unit && (unit->starts_with('/') || unit->starts_with('*'))) *unit = "1" + *unit;  // "1/4096 turn"
  if (!unit || !is_unit(*unit)) {
    const auto meant = unit ? separated_unit(*unit, wanted) : std::nullopt;
    if (!meant) return tl::unexpected(unit_problem(unknown_unit, needed, "unit", parts->unit));
    const auto number = trimmed(text.substr(0, static_cast<std::size_t>(parts->unit.data() - text.data())));
    const std::string value = fmt::format("{} {}", number, *meant);
    return tl::unexpected(
        unit_problem({.code = unknown_unit, .subjects = {{"unit", shortened(parts->unit)}, {"meant", value}}}, value));
  }
  const auto factor = factor_to(*unit, wanted);
  if (!factor) {
    const auto inverse = inverse_of(parts->number, *unit, measure, motion);
    Problem problem = inverse ? Problem{.code = unit_of_other_measure,
                                        .subjects = {{measure == Measure::time ? "period" : "step", *inverse}}}
                              : needs(unit_of_other_measure, needed);
    problem.subjects.push_back({"unit", shortened(parts->unit)});
    problem.subjects.push_back({"measure", std::string(wanted.name)});
    if (std::string_view("aeiou").find(wanted.name.front()) != std::string_view::npos) {
      problem.evidence.push_back({"vowel", 1.0});
    }
    return tl::unexpected(unit_problem(std::move(problem), inverse));
  }
  const double value = scaled(parts->number, *factor);
  if (!std::isfinite(value)) return tl::unexpected(unit_problem({.code = number_beyond_range}));
  return value;
}

}  // namespace zwidth
