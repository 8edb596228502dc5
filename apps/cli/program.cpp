#include "cli/program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commit.hpp"
#include "cli/generate.hpp"
#include "cli/option_units.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "cli/usage_error.hpp"
#include "report/text/text_medium.hpp"
#include "report/text/text_table.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

enum ExitStatus { done = 0, work_failed = 1, bad_input = 2 };

/// Prints every line of `message` as "zwidth: LINE".
void report_problem(std::string message) {
  for (std::size_t at = message.find('\n'); at != std::string::npos; at = message.find('\n', at + 1)) {
    message.insert(at + 1, "zwidth: ");
  }
  write_standard_error("zwidth: " + message + "\n");
}

/// The help with its descriptions broken to the medium's lines; commands stay whole.
std::string help_of(const CLI::App& app, const std::string& name = "") {
  constexpr std::size_t descriptions_from = 30;
  std::istringstream help(app.help(name));
  std::string text;
  bool is_of_commands = false;
  for (std::string line; std::getline(help, line);) {
    is_of_commands = is_of_commands || line == "Examples:";
    const bool is_long = line.size() > report::text_medium().line_length && report::text_medium().line_length > 0;
    if (is_long && !is_of_commands && !line.starts_with("Usage:")) {
      const std::size_t label = line.starts_with(' ') ? descriptions_from : 0;
      line = report::labelled(line.substr(0, label), line.substr(label), label);
      line.pop_back();
    }
    text += line + "\n";
  }
  return text;
}

/// What `zwidth` alone says: where to begin, and the commands in one line.
std::string short_help(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return fmt::format(
      "{}\n\n"
      "  zwidth analyze devices/lhifam.toml                  the stiffest wall of a device, and why\n"
      "  zwidth identify RECORDING --structure DEVICE ...    a device from measurements\n"
      "  zwidth design devices/lhifam.toml                   what to change\n\n"
      "Commands: {}.\n"
      "'zwidth --help' tells what each does, 'zwidth COMMAND --help' how.\n",
      app.get_description(), fmt::join(names, ", "));
}

struct NamedCommand {
  std::string_view name;
  void (*add)(CLI::App& app);
};

constexpr std::array command_table{NamedCommand{"analyze", add_analyze},
                                   NamedCommand{"bode", add_bode},
                                   NamedCommand{"design", add_design},
                                   NamedCommand{"diagnose", add_diagnose},
                                   NamedCommand{"excite", add_excite},
                                   NamedCommand{"export", add_export},
                                   NamedCommand{"frf", add_frf},
                                   NamedCommand{"identify", add_identify},
                                   NamedCommand{"region", add_region},
                                   NamedCommand{"relay", add_relay},
                                   NamedCommand{"reproduce", add_reproduce},
                                   NamedCommand{"rig", add_rig},
                                   NamedCommand{"serve", add_serve},
                                   NamedCommand{"simulate", add_simulate},
                                   NamedCommand{"study", add_study},
                                   NamedCommand{"workspace", add_workspace}};

/// The command that is `asked` for, or all of them: the options of all take as long as an answer.
void add_commands(CLI::App& app, std::string_view asked) {
  const auto* const one = std::ranges::find(command_table, asked, &NamedCommand::name);
  for (const NamedCommand& command : command_table) {
    if (one == command_table.end() || command.name == asked) command.add(app);
  }
}

int run(int argument_count, char** arguments) {
  Program app("The stiffest virtual wall that a haptic device renders stably.", "zwidth");
  app.set_version_flag("--version", fmt::format("zwidth {} ({})", ZWIDTH_VERSION, commit),
                       "Print the version and the commit, and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  zwidth analyze devices/lhifam.toml\n"
      "  zwidth analyze devices/lhifam.toml --set loop.delay=0.25e-3\n"
      "\n"
      "'zwidth COMMAND --help' explains a command.\n"
      "Exit status: 0 done, 1 the work failed, 2 wrong usage or bad input. An answer that is refused\n"
      "(no number is given) is an answer, 0; a file that it would have filled is work that failed, 1.");
  add_commands(app, argument_count < 2 ? "" : arguments[1]);
  for (CLI::App* command : app.get_subcommands({})) command->group("Commands");
  accept_units(app);
  add_generate(app);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("REQUIRED", "");
  if (argument_count < 2) {
    write_standard_error(short_help(app));
    return bad_input;
  }
  try {
    app.parse(argument_count, arguments);
    return done;
  } catch (const Generated&) {
    return done;
  } catch (const CLI::CallForHelp&) {
    const auto parsed = app.get_subcommands();
    write_text(parsed.empty() ? help_of(app) : help_of(*parsed.front(), "zwidth"));
    return done;
  } catch (const CLI::CallForVersion& version) {
    write_standard_output(std::string(version.what()) + "\n");
    return done;
  } catch (const CLI::ParseError& error) {
    throw BadInput("", usage_error(app, error));
  } catch (const RefusedValue& refused) {
    throw BadInput("", usage_error(app, refused.problem));
  }
}

}  // namespace

int run_program(int argument_count, char** arguments) {
  try {
    prepare_standard_output();
    return run(argument_count, arguments);
  } catch (const BadInput& problem) {
    report_problem(problem.what());
    return bad_input;
  } catch (const Error& error) {  // of a key of the device's file: what was asked for does not know it
    report_problem(error.what());
    const bool lies_in_input =
        std::ranges::any_of(error.problems(), [](const auto& each) { return !each.place.key.empty(); });
    return lies_in_input ? bad_input : work_failed;
  } catch (const std::bad_alloc&) {
    report_problem("out of memory");
    return work_failed;
  } catch (const std::exception& problem) {
    report_problem(problem.what());
    return work_failed;
  }
}

}  // namespace zwidth::cli
