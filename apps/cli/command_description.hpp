#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace zwidth::cli {

/// An option or positional argument, as CLI11 knows it.
struct OptionDescription {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional argument its one name
  std::string value;               ///< "FILE"; empty: a flag
  std::vector<std::string> choices;
  std::vector<std::string> words;  ///< that a shell offers: the choices, or the keys of the device file with "="
  bool takes_file = false;
  bool repeats = false;
  bool is_required = false;
  std::string default_value;
  std::string text;
  std::string group;
};

/// A command, or the program itself.
struct CommandDescription {
  std::string name;
  std::string text;
  std::vector<OptionDescription> arguments;  ///< by position
  std::vector<OptionDescription> options;    ///< in the order of the help
  std::vector<std::string> notes;            ///< paragraphs below the options
  std::string examples;                      ///< command lines
};

/// The program first, then its commands in their order. Hidden options are left out.
[[nodiscard]] std::vector<CommandDescription> describe(const CLI::App& app);

}  // namespace zwidth::cli
