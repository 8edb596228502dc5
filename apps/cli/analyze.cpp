#include <memory>
#include <optional>
#include <string>

#include "cli/device_arguments.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/analysed_device.hpp"
#include "report/analysis_json.hpp"
#include "report/analysis_text.hpp"
#include "report/html_report.hpp"
#include "report/output_file.hpp"

namespace zwidth::cli {
namespace {

struct AnalyzeOptions {
  DeviceArguments devices;
  bool json = false;
  std::optional<std::string> report;
};

void run_analyze(const AnalyzeOptions& options) {
  if (options.report) check_output_is_no_input(options.devices, "--report", *options.report);
  const std::vector<report::AnalysedDevice> analysed = analyze_devices(options.devices);
  if (options.report) report::write_whole(*options.report, report::html_report(analysed));
  if (options.json) {
    std::string lines;
    for (const report::AnalysedDevice& each : analysed) lines += report::analysis_json(each).dump() + "\n";
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
  command->footer(
      "Examples:\n"
      "  zwidth analyze devices/lhifam.toml\n"
      "  zwidth analyze devices/lhifam.toml --set wall.stiffness=5000 --set wall.damping=5\n"
      "  zwidth analyze devices/lhifam.toml devices/lhifam_rigid.toml --json\n"
      "  zwidth analyze devices/lhifam.toml --report lhifam.html");
  command->callback([options] { run_analyze(*options); });
}

}  // namespace zwidth::cli
