#include "cli/usage_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <regex>
#include <vector>

#include "cli/number_text.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::cli {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

std::string unknown_argument(const CLI::App& app, const CLI::App& command, const std::string& argument) {
  const bool is_option = argument.size() > 1 && argument.front() == '-';
  const std::string help = &command == &app ? "zwidth --help" : "zwidth " + command.get_name() + " --help";
  if (is_option) {
    const std::string name = argument.substr(0, argument.find('='));
    return fmt::format("unknown option {}{}; see {}", name, did_you_mean(name, option_names(command)), help);
  }
  if (&command != &app) return fmt::format("unexpected argument {}; see {}", argument, help);
  const auto commands = command_names(app);
  return fmt::format("unknown command {}{}; commands are {}; see {}", argument, did_you_mean(argument, commands),
                     fmt::join(commands, ", "), help);
}

}  // namespace

std::string clear_problem(const std::string& message) {
  using std::regex;
  static const regex too_many("(.*): At Most (\\d+) required but received (\\d+)");
  static const regex too_few("(.*): At least (\\d+) required but received (\\d+)");
  static const regex none("(.*): (\\d+) required (.*) missing");
  static const regex other("(.*): (.*) not in \\{(.*)\\}");
  std::smatch part;
  if (std::regex_match(message, part, too_many)) {
    return fmt::format("{}: has {} values; at most {}", part.str(1), part.str(3), part.str(2));
  }
  if (std::regex_match(message, part, too_few)) {
    return fmt::format("{}: has {} of {} values; all of them", part.str(1), part.str(3), part.str(2));
  }
  if (std::regex_match(message, part, none)) return fmt::format("{}: has no value; {}", part.str(1), part.str(3));
  if (!std::regex_match(message, part, other)) return message;
  std::vector<std::string> words = parts_of(part.str(3), ',');
  const std::string near = nearest_word(part.str(2), words);
  if (!near.empty()) words = {fmt::format("did you mean {}?", near)};
  return fmt::format("{}: is {}; {}", part.str(1), part.str(2), fmt::join(words, ", "));
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto parsed = app.get_subcommands();
  const CLI::App& command = parsed.empty() ? app : *parsed.front();
  for (const CLI::App* level : {&app, &command}) {
    for (const std::string& argument : level->remaining()) {
      if (argument != "--") return unknown_argument(app, *level, argument);
    }
  }
  if (parsed.empty() && dynamic_cast<const CLI::RequiredError*>(&error) == nullptr) {
    return fmt::format("{}; see zwidth --help", clear_problem(error.what()));
  }
  if (parsed.empty()) {
    return fmt::format("no command given; commands are {}", fmt::join(command_names(app), ", "));
  }
  return fmt::format("{}: {}; see zwidth {} --help", command.get_name(), clear_problem(error.what()),
                     command.get_name());
}

}  // namespace zwidth::cli
