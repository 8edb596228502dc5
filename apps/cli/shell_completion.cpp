#include "cli/shell_completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>
#include <string_view>

namespace zwidth::cli {
namespace {

std::span<const CommandDescription> subcommands(const std::vector<CommandDescription>& commands) {
  return std::span(commands).subspan(1);
}

std::string names_of(std::span<const CommandDescription> commands) {
  std::vector<std::string> names;
  for (const CommandDescription& command : commands) names.push_back(command.name);
  return fmt::format("{}", fmt::join(names, " "));
}

std::string option_names(const CommandDescription& command) {
  std::vector<std::string> names;
  for (const OptionDescription& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return fmt::format("{}", fmt::join(names, " "));
}

/// In single quotes, with a backslash before each of `special`.
std::string quoted(std::string_view text, std::string_view special, std::string_view single_quote) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += single_quote;
      continue;
    }
    if (special.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result + "'";
}

/// What the first argument must be one of; empty: anything.
std::vector<std::string> first_choices(const CommandDescription& command) {
  return command.arguments.empty() ? std::vector<std::string>{} : command.arguments.front().choices;
}

/// Of the words that are no options: the first argument's choices until one of them stands there, then files.
std::string bash_arguments(const CommandDescription& command) {
  const std::vector<std::string> choices = first_choices(command);
  if (choices.empty()) return command.arguments.empty() ? ":" : "files=1";
  return fmt::format(
      "if [[ \" ${{COMP_WORDS[*]:2:COMP_CWORD-2}} \" =~ \\ ({})\\  ]]; then files=1; else words='{}'; fi",
      fmt::join(choices, "|"), fmt::join(choices, " "));
}

std::string bash_options(const CommandDescription& command, std::string_view otherwise) {
  std::string text = "    case $previous in\n";
  for (const OptionDescription& option : command.options) {
    if (option.value.empty()) continue;
    const std::string what = option.takes_file      ? "files=1"
                             : option.words.empty() ? "return"
                                                    : fmt::format("words='{}'", fmt::join(option.words, " "));
    text += fmt::format("    {}) {} ;;\n", fmt::join(option.names, "|"), what);
  }
  return text + fmt::format("    *) if [[ $current == -* ]]; then words='{}'; else {}; fi ;;\n    esac\n    ;;\n",
                            option_names(command), otherwise);
}

/// One specification of zsh's _arguments: '(-o --output)'{-o+,--output=}'[Figure to write]:FILE:_files'.
std::string zsh_argument(const OptionDescription& option) {
  const bool is_positional = !option.names.front().starts_with('-');
  std::string action;
  const bool is_inconclusive = !option.words.empty() && option.words.front().ends_with('=');  // a value follows
  const std::string_view offer = is_inconclusive ? "{{compadd -S \"\" - {}}}" : "({})";
  if (is_positional || !option.value.empty()) {
    action = fmt::format(":{}:{}", option.value,
                         option.takes_file      ? "_files"
                         : option.words.empty() ? " "
                                                : fmt::format(fmt::runtime(offer), fmt::join(option.words, " ")));
  }
  constexpr std::string_view special = "[]:\\";
  if (is_positional) return fmt::format("'{}{}'", option.repeats ? "*" : "", action);
  std::string spelt;
  for (const std::string& name : option.names) {
    const std::string_view sign = option.value.empty() ? "" : name.starts_with("--") ? "=" : "+";
    spelt += (spelt.empty() ? "" : ",") + name + std::string(sign);
  }
  std::string described = quoted(option.text, special, "'\\''");
  described = fmt::format("'[{}]{}'", described.substr(1, described.size() - 2), action);
  if (option.names.size() == 1) return fmt::format("{}{}{}", option.repeats ? "'*'" : "", spelt, described);
  const std::string exclusive = option.repeats ? "'*'" : fmt::format("'({})'", fmt::join(option.names, " "));
  return fmt::format("{}{{{}}}{}", exclusive, spelt, described);
}

std::string zsh_arguments(const CommandDescription& command) {
  std::string text;
  for (const auto* list : {&command.options, &command.arguments}) {
    for (const OptionDescription& option : *list) text += " \\\n        " + zsh_argument(option);
  }
  return text;
}

std::string fish_option(const OptionDescription& option, std::string_view condition) {
  std::string line = fmt::format("complete -c zwidth -n '{}'", condition);
  for (const std::string& name : option.names) {
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (option.takes_file) {
    line += " -r -F";
  } else if (!option.words.empty()) {
    line += fmt::format(" -x -a '{}'", fmt::join(option.words, " "));
  } else if (!option.value.empty()) {
    line += " -x";
  }
  return line + " -d " + quoted(option.text, "\\", "\\'") + "\n";
}

}  // namespace

std::string bash_completion(const std::vector<CommandDescription>& commands) {
  std::string text = R"(# bash completion of zwidth, made by: zwidth --generate bash
_zwidth() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command= word words= files=
  # Bash makes three words of --option=value.
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word == -* ]] || { command=$word; break; }
  done
  COMPREPLY=()
  case $command in
)";
  text += "  '')\n" + bash_options(commands.front(), fmt::format("words='{}'", names_of(subcommands(commands))));
  for (const CommandDescription& command : subcommands(commands)) {
    text += fmt::format("  {})\n{}", command.name, bash_options(command, bash_arguments(command)));
  }
  return text + R"(  esac
  if [[ -n $files ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    [[ ${COMPREPLY[0]-} != *= ]] || compopt -o nospace 2>/dev/null
  fi
}
complete -F _zwidth zwidth
)";
}

std::string zsh_completion(const std::vector<CommandDescription>& commands) {
  std::string text = "#compdef zwidth\n# zsh completion of zwidth, made by: zwidth --generate zsh\n_zwidth() {\n";
  text += "  local curcontext=$curcontext state line\n  typeset -A opt_args\n  local -a commands=(\n";
  for (const CommandDescription& command : subcommands(commands)) {
    text += "    " + quoted(command.name + ":" + command.text, "", "'\\''") + "\n";
  }
  text += fmt::format("  )\n  _arguments -C{} \\\n        '1:command:->command' '*::argument:->arguments'\n",
                      zsh_arguments(commands.front()));
  text += "  case $state in\n  command) _describe -t commands command commands ;;\n";
  text += "  arguments)\n    case $words[1] in\n";
  for (const CommandDescription& command : subcommands(commands)) {
    text += fmt::format("    {}) _arguments{} ;;\n", command.name, zsh_arguments(command));
  }
  return text + R"(    esac
    ;;
  esac
}
if [[ $funcstack[1] == _zwidth ]]; then
  _zwidth "$@"
else
  compdef _zwidth zwidth
fi
)";
}

std::string fish_completion(const std::vector<CommandDescription>& commands) {
  constexpr std::string_view no_command = "__fish_use_subcommand";
  std::string text = "# fish completion of zwidth, made by: zwidth --generate fish\ncomplete -c zwidth -f\n";
  for (const OptionDescription& option : commands.front().options) text += fish_option(option, no_command);
  for (const CommandDescription& command : subcommands(commands)) {
    text += fmt::format("complete -c zwidth -n '{}' -a {} -d {}\n", no_command, command.name,
                        quoted(command.text, "\\", "\\'"));
  }
  for (const CommandDescription& command : subcommands(commands)) {
    const std::string in_command = "__fish_seen_subcommand_from " + command.name;
    for (const OptionDescription& option : command.options) text += fish_option(option, in_command);
    const std::string choices = fmt::format("{}", fmt::join(first_choices(command), " "));
    if (!choices.empty()) {
      text += fmt::format("complete -c zwidth -n '{}; and not __fish_seen_subcommand_from {}' -a '{}'\n", in_command,
                          choices, choices);
      text += fmt::format("complete -c zwidth -n '{}; and __fish_seen_subcommand_from {}' -F\n", in_command, choices);
    } else if (!command.arguments.empty()) {
      text += fmt::format("complete -c zwidth -n '{}' -F\n", in_command);
    }
  }
  return text;
}

}  // namespace zwidth::cli
