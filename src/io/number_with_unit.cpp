#include "zwidth/io/number_with_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

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

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

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
double scaled(double number, double factor) {
  constexpr double largest_exact = 1e15;
  const double inverse = std::round(1.0 / factor);
  constexpr double rounding = 4.0 * 2.220446049250313e-16;
  const bool is_division = factor < 1.0 && inverse < largest_exact && std::abs(inverse * factor - 1.0) <= rounding;
  return is_division ? number / inverse : number * factor;
}

std::optional<double> factor_to(const std::string& unit, const MeasuredUnit& wanted) {
  if (const auto factor = unit_factor(unit, wanted.si.empty() ? "1" : std::string(wanted.si))) return factor;
  if (wanted.without.empty()) return std::nullopt;
  return unit_factor(unit, std::string(wanted.without));
}

/// A time that is given as its frequency, a step as counts per turn: what to write instead.
std::optional<std::string> inverse_remedy(double number, const std::string& unit, Measure measure, Motion motion) {
  const double magnitude = std::abs(number);
  if (measure == Measure::time) {
    const auto factor = unit_factor(unit, "Hz");
    if (factor && magnitude > 0.0) {
      const double rate = number * *factor;
      const std::string brief = fmt::format("{:.6g}", 1.0 / rate);
      double read = 0.0;
      std::from_chars(brief.data(), brief.data() + brief.size(), read);
      const bool is_exact = read == 1.0 / rate;
      return fmt::format("a period is 1/frequency: \"{}\"", is_exact ? brief + " s" : fmt::format("1 s/{:.10g}", rate));
    }
  }
  const std::string per = motion == Motion::rotary ? "rad^-1" : "m^-1";
  if (measure == Measure::position) {
    const auto factor = unit_factor(unit, per);
    if (factor && magnitude > 0.0) {
      const bool is_rotary = motion == Motion::rotary;
      const double counts = number * *factor * (is_rotary ? 2.0 * std::numbers::pi : 1e-3);
      return fmt::format("a step is its inverse: \"1 {}/{:.10g}\"", is_rotary ? "turn" : "mm", counts);
    }
  }
  return std::nullopt;
}

}  // namespace

std::string_view si_unit(Measure measure, Motion motion) { return unit_of(measure, motion).si; }

std::optional<Measure> measure_of(std::string_view key) {
  constexpr std::pair<std::string_view, Measure> keys[] = {{"mass", Measure::mass},
                                                           {"inertia", Measure::mass},
                                                           {"damping", Measure::damping},
                                                           {"stiffness", Measure::stiffness},
                                                           {"coulomb", Measure::force},
                                                           {"force_limit", Measure::force},
                                                           {"resolution", Measure::position},
                                                           {"sampling_period", Measure::time},
                                                           {"delay", Measure::time},
                                                           {"time_constant", Measure::time},
                                                           {"travel", Measure::position},
                                                           {"torque_constant", Measure::torque_per_current},
                                                           {"torque_per_volt", Measure::torque_per_voltage},
                                                           {"velocity_filter_hz", Measure::frequency_hz},
                                                           {"velocity_filter_tau", Measure::time},
                                                           {"frequency_hz", Measure::frequency_hz},
                                                           {"damping_ratio", Measure::ratio},
                                                           {"depth", Measure::ratio},
                                                           {"ratio", Measure::ratio}};
  const std::string_view last = key.substr(key.rfind('.') + 1);  // npos + 1 is 0
  const auto* const found = std::ranges::find(keys, last, [](const auto& each) { return each.first; });
  return found == std::end(keys) ? std::nullopt : std::optional(found->second);
}

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
                                      "the decimal mark is a point, and nothing stands between thousands"});
  }
  // A second number would multiply the first: "1 000 N/m" is refused.
  const bool begins_as_unit = std::string_view(".+-0123456789").find(parts->unit.front()) == std::string_view::npos;
  auto unit = begins_as_unit ? ascii_unit(parts->unit) : std::nullopt;
  if (unit && (unit->starts_with('/') || unit->starts_with('*'))) *unit = "1" + *unit;  // "1/4096 turn"
  if (!unit || !is_unit(*unit)) {
    return tl::unexpected(UnitProblem{fmt::format("cannot read the unit {}", in_quotes(parts->unit)), allowed});
  }
  const auto factor = factor_to(*unit, wanted);
  if (!factor) {
    return tl::unexpected(UnitProblem{fmt::format("{} is no unit of {}", in_quotes(parts->unit), wanted.name),
                                      inverse_remedy(parts->number, *unit, measure, motion).value_or(allowed)});
  }
  const double value = scaled(parts->number, *factor);
  if (!std::isfinite(value)) {
    return tl::unexpected(UnitProblem{std::string(number_out_of_range), std::string(number_range)});
  }
  return value;
}

}  // namespace zwidth
