#include "cli/usage_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace zwidth::cli {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::string unknown_argument(const CLI::App& app, const CLI::App& command, const std::string& argument) {
  const bool is_option = argument.size() > 1 && argument.front() == '-';
  if (&command == &app && !is_option) {
    return fmt::format("unknown command '{}'; commands are {}", argument, fmt::join(command_names(app), ", "));
  }
  return fmt::format("{} '{}'; see {} --help", is_option ? "unknown option" : "unexpected argument", argument,
                     &command == &app ? "zwidth" : "zwidth " + command.get_name());
}

}  // namespace

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto parsed = app.get_subcommands();
  const CLI::App& command = parsed.empty() ? app : *parsed.front();
  for (const CLI::App* level : {&app, &command}) {
    const auto left_over = level->remaining();
    if (!left_over.empty()) return unknown_argument(app, *level, left_over.front());
  }
  if (parsed.empty()) {
    return fmt::format("no command given\nusage: zwidth COMMAND [FILE...] [options]\ncommands: {}\nsee zwidth --help",
                       fmt::join(command_names(app), ", "));
  }
  return fmt::format("{}: {}; see zwidth {} --help", command.get_name(), error.what(), command.get_name());
}

}  // namespace zwidth::cli
