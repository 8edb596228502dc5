#include "cli/command_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include "zwidth/model/device_key.hpp"

namespace zwidth::cli {
namespace {

/// The words of "KIND:{bilateral,unilateral}"; none where the value is free.
std::vector<std::string> choices_in(const std::string& type) {
  std::vector<std::string> choices;
  const auto begin = type.find('{');
  const auto end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::istringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(list, word, ',');) choices.push_back(word);
  return choices;
}

bool names_file(std::string_view value) {
  return value.find("FILE") != std::string_view::npos || value.starts_with("OUT") || value == "DEVICE";
}

/// "loop.delay=", "body.0.mass=": every key of the device file as an override begins.
std::vector<std::string> key_words() {
  std::vector<std::string> words;
  for (const DeviceTableKey& table : device_tables()) {
    const std::string path = path_of(table.table) + (table.is_many ? ".0" : table.is_by_name ? ".NAME" : "");
    for (const DeviceKey& key : device_keys()) {
      if (key.table == table.table) words.push_back(fmt::format("{}{}{}=", path, path.empty() ? "" : ".", key.name));
    }
  }
  return words;
}

OptionDescription described(const CLI::Option& option) {
  OptionDescription description;
  for (const std::string& name : option.get_snames()) description.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) description.names.push_back("--" + name);
  const bool is_positional = description.names.empty();
  if (is_positional) description.names.push_back(option.get_name(true));
  if (option.get_type_size_max() > 0) {
    const std::string type = option.get_type_name();
    description.value = is_positional ? description.names.front() : type.substr(0, type.find(':'));
    description.choices = choices_in(type);
    description.words = type.starts_with("KEY=") ? key_words() : description.choices;
    description.default_value = option.get_default_str();
  }
  description.takes_file = names_file(description.value);
  description.repeats =
      !description.value.empty() && option.get_items_expected_max() > 1 && option.get_items_expected_min() < 2;
  description.is_required = option.get_required();
  description.group = option.get_group();
  description.text = option.get_description();
  std::ranges::replace(description.text, '\n', ' ');
  return description;
}

void add_footer(const std::string& footer, CommandDescription& command) {
  std::istringstream lines(footer);
  bool continues = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) {
      command.examples += line.substr(2) + "\n";
      continues = false;
    } else if (line.empty() || line == "Examples:") {
      continues = false;
    } else {
      const bool is_sentence = continues && !command.notes.back().ends_with('.');
      is_sentence ? command.notes.back() += " " + line : command.notes.emplace_back(line);
      continues = true;
    }
  }
}

CommandDescription described(const CLI::App& app) {
  CommandDescription command;
  command.name = app.get_name();
  command.text = app.get_description();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    OptionDescription description = described(*option);
    const bool is_positional = !description.names.front().starts_with('-');
    (is_positional ? command.arguments : command.options).push_back(std::move(description));
  }
  add_footer(app.get_footer(), command);
  return command;
}

}  // namespace

std::vector<CommandDescription> describe(const CLI::App& app) {
  std::vector<CommandDescription> all{described(app)};
  for (const CLI::App* command : app.get_subcommands({})) all.push_back(described(*command));
  return all;
}

}  // namespace zwidth::cli
