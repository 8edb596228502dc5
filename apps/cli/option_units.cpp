#include "cli/option_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/number_text.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array<std::pair<std::string_view, Measure>, 9> measured_values{{{"S", Measure::time},
                                                                               {"HZ", Measure::frequency_hz},
                                                                               {"W", Measure::angular_frequency},
                                                                               {"RAD/S", Measure::angular_frequency},
                                                                               {"M", Measure::position},
                                                                               {"F", Measure::force},
                                                                               {"FORCE", Measure::force},
                                                                               {"K", Measure::stiffness},
                                                                               {"B", Measure::damping}}};

constexpr std::string_view range_begin = ":INT in [";

bool has_unit(std::string_view text) {
  return text.find_first_of("0123456789") != std::string_view::npos &&
         text.find_first_not_of("0123456789.+-eE") != std::string_view::npos;
}

/// A number with a unit as the number in SI units, and one without as it is.
std::string without_unit(const std::string& text, Measure measure, const std::string& option, Program& program) {
  if (!has_unit(text)) {
    double value = 0.0;
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* const end = text.data() + text.size();
    // Infinities and what is too large or too small are told by who knows the range.
    if (const auto read = std::from_chars(begin, end, value); read.ptr == end && begin != end) return text;
    throw RefusedValue{problem_of_value(option, fmt::format("{} is no number", in_quotes(text)),
                                        allowed_numbers(measure, Motion::linear), with_decimal_point(text))};
  }
  const auto problem_of = [](const auto& read) {
    return read ? std::nullopt : std::optional<UnitProblem>(read.error());
  };
  const auto linear = number_with_unit(text, measure, Motion::linear);
  const auto rotary = number_with_unit(text, measure, Motion::rotary);
  if (!linear && !rotary) throw RefusedValue{problem_of_value(option, linear.error())};
  program.given_units.push_back({option, problem_of(linear), problem_of(rotary)});
  return fmt::format("{}", linear ? *linear : *rotary);
}

struct WholeNumbers {
  std::uint64_t least = 0;
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
};

/// What the checks of an option allow, by its description: "N:INT in [64 - 16777216]".
WholeNumbers allowed_by(const std::string& type) {
  WholeNumbers allowed{.least = type.ends_with(":POSITIVE") ? 1U : 0U};
  if (type == "PORT") allowed.most = std::numeric_limits<std::uint16_t>::max();
  const std::size_t begin = type.find(range_begin);
  if (begin == std::string::npos) return allowed;
  const char* const text = type.data() + begin + range_begin.size();
  const char* const end = type.data() + type.size();
  const auto least = std::from_chars(text, end, allowed.least);
  std::from_chars(std::min(least.ptr + std::string_view(" - ").size(), end), end, allowed.most);
  return allowed;
}

/// CLI11 takes more: -1 as 2^64 - 1, 010 as 8, 0x10 as 16.
std::string whole_number(const std::string& text, const WholeNumbers& allowed, const std::string& option) {
  std::uint64_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = failure == std::errc() && end == text.data() + text.size();
  if (is_whole && value >= allowed.least && value <= allowed.most) return fmt::format("{}", value);
  const bool is_bounded = allowed.most != WholeNumbers{}.most || failure == std::errc::result_out_of_range;
  const std::string range = is_bounded ? fmt::format("a whole number from {} to {}", allowed.least, allowed.most)
                                       : fmt::format("a whole number, {} or more", allowed.least);
  throw RefusedValue{problem_of_value(option, fmt::format("is {}", text), range)};
}

}  // namespace

tl::expected<double, UnitProblem> measured_number(std::string_view text, Measure measure, Motion motion) {
  if (has_unit(text)) return number_with_unit(text, measure, motion);
  if (const auto number = number_in(text)) return *number;
  return tl::unexpected(
      UnitProblem{fmt::format("\"{}\" is no number of at most 1e30", text), allowed_numbers(measure, motion)});
}

double measured_number(const std::string& option, std::string_view text, Measure measure, Motion motion) {
  const auto value = measured_number(text, measure, motion);
  if (!value) throw BadInput(problem_of_value(option, value.error()));
  return *value;
}

void accept_units(Program& program) {
  for (CLI::App* command : program.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      const std::string_view plain = std::string_view(type).substr(0, type.find(':'));
      if (plain == "N" || plain == "BITS" || plain == "PORT") {
        option->transform([allowed = allowed_by(type), called = option->get_name()](const std::string& text) {
          return whole_number(text, allowed, called);
        });
      }
      for (const auto& [name, measure] : measured_values) {
        if (plain != name) continue;
        option->transform([&program, unit = measure, called = option->get_name()](const std::string& text) {
          return without_unit(text, unit, called, program);
        });
      }
      // The last to be added is the first to look. A file that is no option says itself that it has no name.
      if (!plain.empty() && !option->get_positional()) {
        option->transform([called = option->get_name()](const std::string& text) {
          if (text.empty()) throw RefusedValue{problem_of_value(called, "is empty", "a value")};
          return text;
        });
      }
    }
  }
}

void check_option_units(const CLI::App& command, Motion motion) {
  const auto* const program = dynamic_cast<const Program*>(command.get_parent());
  if (program == nullptr) return;
  for (const GivenUnit& each : program->given_units) {
    const auto& problem = motion == Motion::linear ? each.linear : each.rotary;
    if (problem) throw BadInput(problem_of_value(each.option, *problem));
  }
}

}  // namespace zwidth::cli
