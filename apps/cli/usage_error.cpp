#include "cli/usage_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <string_view>
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
std::string clear_problem(const std::string& message) {
  const auto too_many = parted(message, ": At Most ");
  const auto too_few = parted(message, ": At least ");
  if (const auto& wrong = too_many ? too_many : too_few) {
    if (const auto counts = parted(wrong->after, " required but received ")) {
      return too_many
                 ? fmt::format("{}: has {} values; at most {}", wrong->before, counts->after, counts->before)
                 : fmt::format("{}: has {} of {} values; all of them", wrong->before, counts->after, counts->before);
    }
  }
  const auto required = parted(message, " required ");
  if (const auto kind = required ? parted(required->after, " missing") : std::nullopt; kind && kind->after.empty()) {
    if (const auto count = parted(required->before, ": "))
      return fmt::format("{}: has no value; {}", count->before, kind->before);
  }
  if (const auto wrong = parted(message, "Could not convert: ")) {
    if (const auto value = parted(wrong->after, " = ")) {
      return fmt::format("{}: is {}; a number, without a unit", value->before, value->after);
    }
  }
  const auto choice = parted(message, " not in {");
  if (!choice || !choice->after.ends_with('}')) return message;
  const auto given = parted(choice->before, ": ");
  if (!given) return message;
  std::vector<std::string> words = parts_of(choice->after.substr(0, choice->after.size() - 1), ',');
  const std::string near = nearest_word(given->after, words);
  if (!near.empty()) words = {fmt::format("did you mean {}?", near)};
  return fmt::format("{}: is {}; {}", given->before, given->after, fmt::join(words, ", "));
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
