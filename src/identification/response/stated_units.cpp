#include "identification/response/stated_units.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string>

#include "counted.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

constexpr std::size_t longest_unit = 24;  // characters, of what is one

/// In which a channel's samples are, by its name in all recordings; empty where they state none, or several.
std::string stated_unit(std::span<const Recording> recordings, std::size_t channel) {
  const auto unit_of = [&](const Recording& recording) {
    const Channel& each = recording.channels[channel];
    return each.base_unit.empty() ? each.unit : each.base_unit;
  };
  const std::string unit = unit_of(recordings.front());
  if (unit.size() > longest_unit) return "";
  const bool is_same = std::ranges::all_of(recordings, [&](const auto& each) { return unit_of(each) == unit; });
  return is_same ? unit : "";
}

std::string lower_name(const Channel& channel) {
  std::string name = channel.name;
  std::ranges::transform(name, name.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return name;
}

/// Of force and motion: a torque, and what a torque turns, both without a unit.
bool is_called_rotary(const Recording& recording) {
  if (recording.channels.size() != 2 || lower_name(recording.channels[0]) != "torque") return false;
  const std::string motion = lower_name(recording.channels[1]);
  return motion == "angle" || motion == "position";
}

}  // namespace

namespace internal {

void state_units(MeasuredResponse& measured, std::span<const Recording> recordings) {
  measured.force_unit = stated_unit(recordings, 0);
  measured.length_unit = stated_unit(recordings, 1);
  measured.length_unit.resize(std::min(measured.length_unit.size(), measured.length_unit.find("/s")));
  if (stated_motion(recordings) == Motion::rotary) {
    if (measured.force_unit.empty()) measured.force_unit = "N m";
    if (measured.length_unit.empty()) measured.length_unit = "rad";
  }
}

}  // namespace internal

std::optional<Motion> stated_motion(std::span<const Recording> recordings) {
  bool is_linear = false;
  bool is_rotary = false;
  for (const Recording& recording : recordings) {
    for (const Channel& channel : recording.channels) {
      const std::string& unit = channel.base_unit;
      is_rotary = is_rotary || unit == "N m" || unit.starts_with("rad");
      is_linear = is_linear || unit == "N" || unit == "m" || unit.starts_with("m/");
    }
  }
  if (is_linear != is_rotary) return is_rotary ? Motion::rotary : Motion::linear;
  if (is_linear) return std::nullopt;
  const bool is_rotary_by_name = !recordings.empty() && std::ranges::all_of(recordings, is_called_rotary);
  return is_rotary_by_name ? std::optional(Motion::rotary) : std::nullopt;
}

std::optional<OptionProblem> find_problem(const std::string& force_unit, const std::string& length_unit,
                                          const MeasuredResponse& measured) {
  const auto check = [](const char* member, const std::string& given,
                        const std::string& stated) -> std::optional<OptionProblem> {
    const bool is_plain =
        given.size() <= longest_unit && std::ranges::none_of(given, [](unsigned char c) { return c < ' '; });
    if (!is_plain)
      return option_problem(member,
                            {.code = ProblemCode::no_unit_text, .evidence = {internal::counted("most", longest_unit)}});
    if (given.empty() || stated.empty() || given == stated) return std::nullopt;
    return option_problem(
        member, {.code = ProblemCode::unit_of_other_column, .subjects = {{"given", given}, {"stated", stated}}});
  };
  auto problem = check("force_unit", force_unit, measured.force_unit);
  return problem ? problem : check("length_unit", length_unit, measured.length_unit);
}

}  // namespace zwidth
