#include "cli/usage_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/number_text.hpp"
#include "cli/subcommand.hpp"
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

struct Parted {
  std::string before;
  std::string after;
};

// What stands around the last such phrase.
std::optional<Parted> parted(const std::string& text, std::string_view phrase) {
  const std::size_t at = text.rfind(phrase);
  if (at == std::string::npos) return std::nullopt;
  return Parted{text.substr(0, at), text.substr(at + phrase.size())};
}

}  // namespace

// By searching: std::regex takes stack for every character, and a message holds what the user gave.
InputProblem problem_of_cli11(const std::string& message) {
  const auto too_many = parted(message, ": At Most ");
  const auto too_few = parted(message, ": At least ");
  if (const auto& wrong = too_many ? too_many : too_few) {
    if (const auto counts = parted(wrong->after, " required but received ")) {
      return too_many
                 ? problem_of_value(wrong->before, fmt::format("has {} values", counts->after),
                                    fmt::format("at most {}", counts->before))
                 : problem_of_value(wrong->before, fmt::format("has {} of {} values", counts->after, counts->before),
                                    "all of them");
    }
  }
  const auto required = parted(message, " required ");
  if (const auto kind = required ? parted(required->after, " missing") : std::nullopt; kind && kind->after.empty()) {
    if (const auto count = parted(required->before, ": "))
      return problem_of_value(count->before, "has no value", kind->before);
  }
  if (const auto wrong = parted(message, "Could not convert: ")) {
    if (const auto value = parted(wrong->after, " = ")) {
      return problem_of_value(value->before, fmt::format("is {}", value->after), "a number, without a unit",
                              with_decimal_point(value->after));
    }
  }
  const auto choice = parted(message, " not in {");
  const auto given = choice && choice->after.ends_with('}') ? parted(choice->before, ": ") : std::nullopt;
  if (!given) return problem_of_value("", CommandText(message.c_str()), "");
  const std::vector<std::string> words = parts_of(choice->after.substr(0, choice->after.size() - 1), ',');
  const std::string near = nearest_word(given->after, words);
  const std::string what = fmt::format("is {}", given->after);
  if (near.empty()) return problem_of_value(given->before, what, fmt::format("{}", fmt::join(words, ", ")));
  return problem_of_value(given->before, what, fmt::format("did you mean {}?", near), near);
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
    return fmt::format("{}; see zwidth --help", problem_of_cli11(error.what()).str());
  }
  if (parsed.empty()) {
    return fmt::format("no command given; commands are {}", fmt::join(command_names(app), ", "));
  }
  return usage_error(app, problem_of_cli11(error.what()));
}

std::string usage_error(const CLI::App& app, const InputProblem& problem) {
  const std::string command = app.get_subcommands().front()->get_name();
  return fmt::format("{}: {}; see zwidth {} --help", command, problem.str(), command);
}

}  // namespace zwidth::cli
