#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <exception>
#include <new>
#include <string>

#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "cli/usage_error.hpp"

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

int run(int argument_count, char** arguments) {
  CLI::App app("The stiffest virtual wall that a haptic device renders stably.", "zwidth");
  app.set_version_flag("--version", "zwidth " ZWIDTH_VERSION, "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  zwidth analyze devices/lhifam.toml\n"
      "  zwidth analyze devices/lhifam.toml --set loop.delay=0.25e-3\n"
      "\n"
      "'zwidth COMMAND --help' explains a command.\n"
      "Exit status: 0 done, 1 the work failed, 2 wrong usage or bad input.");
  add_analyze(app);
  add_bode(app);
  add_design(app);
  add_excite(app);
  add_export(app);
  add_frf(app);
  add_identify(app);
  add_region(app);
  add_relay(app);
  add_reproduce(app);
  add_simulate(app);
  for (CLI::App* command : app.get_subcommands({})) command->group("Commands");
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("REQUIRED", "");
  if (argument_count < 2) {
    write_standard_error(app.help());
    return bad_input;
  }
  try {
    app.parse(argument_count, arguments);
    return done;
  } catch (const CLI::CallForHelp&) {
    const auto parsed = app.get_subcommands();
    write_standard_output(parsed.empty() ? app.help() : parsed.front()->help("zwidth"));
    return done;
  } catch (const CLI::CallForVersion& version) {
    write_standard_output(std::string(version.what()) + "\n");
    return done;
  } catch (const CLI::ParseError& error) {
    throw BadInput(usage_error(app, error));
  }
}

}  // namespace
}  // namespace zwidth::cli

int main(int argument_count, char** arguments) {
  using namespace zwidth::cli;
  try {
    prepare_standard_output();
    return run(argument_count, arguments);
  } catch (const BadInput& problem) {
    report_problem(problem.what());
    return bad_input;
  } catch (const std::bad_alloc&) {
    report_problem("out of memory");
    return work_failed;
  } catch (const std::exception& problem) {
    report_problem(problem.what());
    return work_failed;
  }
}
