#include "cli/manual_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <string_view>

namespace zwidth::cli {
namespace {

/// Text that groff prints as it stands.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\'') {
      result += "\\(aq";
    } else if (c == '^') {
      result += "\\(ha";
    } else if (c == '~') {
      result += "\\(ti";
    } else {
      result += c;
    }
  }
  if (result.starts_with('.')) result.insert(0, "\\&");
  return result;
}

std::string verbatim(const std::string& lines) {
  std::string text = ".EX\n";
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) text += escaped(line) + "\n";
  return text + ".EE\n";
}

std::string option_entry(const OptionDescription& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back("\\fB" + escaped(name) + "\\fR");
  std::string text = fmt::format(".TP\n{}", fmt::join(names, ", "));
  const bool is_positional = !option.names.front().starts_with('-');
  if (!option.value.empty() && !is_positional) text += " \\fI" + escaped(option.value) + "\\fR";
  text += "\n" + escaped(option.text) + ".\n";
  if (!option.choices.empty()) text += escaped(fmt::format("One of {}.", fmt::join(option.choices, ", "))) + "\n";
  if (!option.default_value.empty()) text += escaped("Default: " + option.default_value + ".") + "\n";
  return text;
}

std::string option_sections(const CommandDescription& command) {
  std::string text;
  for (const OptionDescription& argument : command.arguments) text += option_entry(argument);
  if (!text.empty()) text = ".SH ARGUMENTS\n" + text;
  std::string group;
  for (const OptionDescription& option : command.options) {
    if (option.group != group) {
      text += group.empty() ? ".SH OPTIONS\n" : ".SS " + escaped(option.group) + "\n";
      group = option.group;
    }
    text += option_entry(option);
  }
  return text;
}

std::string synopsis(const CommandDescription& command, std::string_view called, bool is_program) {
  std::string text = fmt::format(".SH SYNOPSIS\n.B {}\n", escaped(called));
  if (is_program) return text + "\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  text += "[\\fIOPTIONS\\fR]";
  for (const OptionDescription& argument : command.arguments) {
    const std::string name =
        fmt::format("\\fI{}\\fR{}", escaped(argument.names.front()), argument.repeats ? " ..." : "");
    text += argument.is_required ? " " + name : " [" + name + "]";
  }
  return text + "\n";
}

}  // namespace

std::string manual_page(const std::vector<CommandDescription>& commands, const CommandDescription& command) {
  const CommandDescription& program = commands.front();
  const bool is_program = command.name == program.name;
  const std::string page = is_program ? program.name : program.name + "-" + command.name;
  const std::string called = is_program ? program.name : program.name + " " + command.name;
  std::string text = fmt::format(".\\\" Made by: {0} --generate man{1}\n.TH {2} 1 \"\" \"zwidth {3}\" \"zwidth\"\n",
                                 program.name, is_program ? "" : "-" + command.name, escaped(page), ZWIDTH_VERSION);
  text += fmt::format(".SH NAME\n{} \\- {}\n", escaped(page), escaped(command.text));
  text += synopsis(command, called, is_program);
  if (!command.notes.empty()) {
    text += ".SH DESCRIPTION\n";
    for (const std::string& note : command.notes) text += ".PP\n" + escaped(note) + "\n";
  }
  if (is_program) {
    text += ".SH COMMANDS\n";
    for (std::size_t i = 1; i < commands.size(); ++i) {
      text += fmt::format(".TP\n\\fB{}\\fR\n{}.\n", escaped(commands[i].name), escaped(commands[i].text));
    }
  }
  text += option_sections(command);
  if (!command.examples.empty()) text += ".SH EXAMPLES\n" + verbatim(command.examples);
  text += ".SH SEE ALSO\n";
  std::vector<std::string> others;
  for (const CommandDescription& each : commands) {
    if (each.name == command.name) continue;
    const std::string name = each.name == program.name ? each.name : program.name + "-" + each.name;
    others.push_back(fmt::format(".BR \\%{} (1)", escaped(name)));  // \%: no hyphen in it
  }
  return text + fmt::format("{}\n", fmt::join(others, ",\n"));
}

}  // namespace zwidth::cli
