#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/progress_line.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "cli/users_argument.hpp"
#include "report/analysed_device.hpp"
#include "report/output_file.hpp"
#include "report/page/html_report.hpp"
#include "report/text/analysis_text.hpp"
#include "results/analysis_json.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

struct AnalyzeOptions {
  DeviceArguments devices;
  bool json = false;
  std::optional<std::string> report;
  bool worst_user = false;
  std::string users;
};

void check_that_it_can_be_held(const std::string& option, const std::string& file, const Device& device) {
  if (!device.has_bodies()) {
    throw BadInput(fmt::format("{}: {}: is a transfer function; it has no body to hold", option, file));
  }
}

/// Whether --worst-user and --users can be answered for every device.
void check_users(const AnalyzeOptions& options, const std::vector<Device>& devices) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const std::string& file = options.devices.files[i];
    if (options.worst_user) {
      check_that_it_can_be_held("--worst-user", file, devices[i]);
      if (devices[i].bodies().size() > report::most_bodies_for_any_user) {
        throw BadInput(fmt::format("--worst-user: {}: has {} bodies; at most {}", file, devices[i].bodies().size(),
                                   report::most_bodies_for_any_user));
      }
    }
    if (!options.users.empty()) check_that_it_can_be_held("--users", file, devices[i]);
  }
}

/// What --worst-user and --users ask for.
void answer_about_users(const AnalyzeOptions& options, const std::optional<UserRanges>& ranges,
                        std::vector<report::AnalysedDevice>& analysed) {
  for (std::size_t i = 0; i < analysed.size(); ++i) {
    report::AnalysedDevice& each = analysed[i];
    try {
      if (options.worst_user) report::find_worst_user(each);
      if (ranges) {
        ProgressLine line("searching the users");
        report::search_user_family(each, user_family(*ranges, each.device.parameters().user), line.progress());
      }
    } catch (const Error& error) {
      throw WorkFailed(options.devices.files[i] + ": " + error.what());
    }
  }
}

void run_analyze(const AnalyzeOptions& options) {
  if (options.report) check_output_is_no_input(options.devices, "--report", *options.report);
  std::optional<UserRanges> ranges;
  if (!options.users.empty()) ranges = user_ranges(options.users);
  std::vector<Device> devices = read_devices(options.devices);
  check_users(options, devices);
  std::vector<report::AnalysedDevice> analysed = analyze_devices(options.devices, std::move(devices));
  answer_about_users(options, ranges, analysed);
  if (options.report) report::write_whole(*options.report, report::html_report(analysed));
  if (options.json) {
    std::string lines;
    for (const report::AnalysedDevice& each : analysed) lines += results::line(results::analysis_json(each));
    write_standard_output(lines);
  } else {
    write_standard_output(report::analysis_text(analysed));
    if (options.report) write_standard_output("\nThe report is in " + *options.report + "\n");
  }
}

}  // namespace

void add_analyze(CLI::App& app) {
  auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command = app.add_subcommand("analyze", "Critical stiffness, what limits it, and the margins of a wall");
  add_device_arguments(*command, options->devices, FileCount::several);
  command->add_flag("--json", options->json, "Print one JSON document per device, one per line");
  command->add_option("--report", options->report, "Also write one self-contained page with figures")
      ->type_name("OUT.html");
  command->add_flag("--worst-user", options->worst_user,
                    "Also name the passive user who proves the limit for any user tight");
  command->add_option("--users", options->users, "Also search a family of users: ranges of mass, damping, stiffness")
      ->type_name("RANGES")
      ->check([](const std::string& text) { return text.empty() ? "is empty" : ""; });
  command->footer(
      "Examples:\n"
      "  zwidth analyze devices/lhifam.toml\n"
      "  zwidth analyze devices/lhifam.toml --set wall.stiffness=5000 --set wall.damping=5\n"
      "  zwidth analyze devices/lhifam.toml devices/lhifam_rigid.toml --json\n"
      "  zwidth analyze devices/lhifam.toml --worst-user --users mass=0:2,damping=0:30,stiffness=0:1000\n"
      "  zwidth analyze devices/lhifam.toml --report lhifam.html");
  command->callback([options] { run_analyze(*options); });
}

}  // namespace zwidth::cli
