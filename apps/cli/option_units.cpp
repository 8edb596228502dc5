#include "cli/option_units.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/number_text.hpp"
#include "cli/subcommand.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array<std::pair<std::string_view, Measure>, 8> measured_values{{{"S", Measure::time},
                                                                               {"HZ", Measure::frequency_hz},
                                                                               {"W", Measure::angular_frequency},
                                                                               {"M", Measure::position},
                                                                               {"F", Measure::force},
                                                                               {"FORCE", Measure::force},
                                                                               {"K", Measure::stiffness},
                                                                               {"B", Measure::damping}}};

/// An option with a unit, given before the device and so its motion is known.
struct GivenUnit {
  std::string option;
  std::string text;
  Measure measure = Measure::time;
};

std::vector<GivenUnit>& given_units() {
  static thread_local std::vector<GivenUnit> given;
  return given;
}

std::string problem_text(const UnitProblem& problem) { return problem.what + "; " + problem.allowed; }

bool has_unit(std::string_view text) {
  return text.find_first_of("0123456789") != std::string_view::npos &&
         text.find_first_not_of("0123456789.+-eE") != std::string_view::npos;
}

/// A number with a unit as the number in SI units; all else as it is, for CLI11 to judge.
std::string without_unit(const std::string& text, Measure measure, const std::string& option) {
  if (!has_unit(text)) return text;
  given_units().push_back({option, text, measure});
  const auto linear = number_with_unit(text, measure, Motion::linear);
  if (linear) return fmt::format("{}", *linear);
  const auto rotary = number_with_unit(text, measure, Motion::rotary);
  if (rotary) return fmt::format("{}", *rotary);
  throw CLI::ValidationError(problem_text(linear.error()));
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
  if (!value) throw BadInput(option + ": " + problem_text(value.error()));
  return *value;
}

void accept_units(CLI::App& app) {
  given_units().clear();
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      for (const auto& [name, measure] : measured_values) {
        if (type.substr(0, type.find(':')) != name) continue;
        option->transform([unit = measure, called = option->get_name()](const std::string& text) {
          return without_unit(text, unit, called);
        });
      }
    }
  }
}

void check_option_units(Motion motion) {
  for (const GivenUnit& each : given_units()) {
    const auto value = number_with_unit(each.text, each.measure, motion);
    if (!value) throw BadInput(each.option + ": " + problem_text(value.error()));
  }
}

}  // namespace zwidth::cli
