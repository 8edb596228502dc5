#include "cli/option_units.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "zwidth/io/number_with_unit.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array<std::pair<std::string_view, Measure>, 3> measured_values{
    {{"S", Measure::time}, {"HZ", Measure::frequency_hz}, {"W", Measure::angular_frequency}}};

/// A number with a unit as the number in SI units; all else as it is, for CLI11 to judge.
std::string without_unit(const std::string& text, Measure measure) {
  const bool has_unit = text.find_first_of("0123456789") != std::string::npos &&
                        text.find_first_not_of("0123456789.+-eE") != std::string::npos;
  if (!has_unit) return text;
  const auto value = number_with_unit(text, measure, Motion::linear);  // of these, the same in rotary motion
  if (!value) throw CLI::ValidationError(value.error().what + "; " + value.error().allowed);
  return fmt::format("{}", *value);
}

}  // namespace

void accept_units(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      for (const auto& [type, measure] : measured_values) {
        if (option->get_type_name() != type) continue;
        option->transform([unit = measure](const std::string& text) { return without_unit(text, unit); });
      }
    }
  }
}

}  // namespace zwidth::cli
