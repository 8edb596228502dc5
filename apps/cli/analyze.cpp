#include <memory>

#include "cli/device_arguments.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/analysed_device.hpp"
#include "report/analysis_json.hpp"
#include "report/analysis_text.hpp"

namespace zwidth::cli {
namespace {

struct AnalyzeOptions {
  DeviceArguments devices;
  bool json = false;
};

void run_analyze(const AnalyzeOptions& options) {
  std::vector<report::AnalysedDevice> analysed;
  for (Device& device : read_devices(options.devices)) {
    Analysis analysis = analyze(device);
    analysed.push_back({std::move(device), std::move(analysis)});
  }
  if (options.json) {
    std::string lines;
    for (const report::AnalysedDevice& each : analysed) lines += report::analysis_json(each).dump() + "\n";
    write_standard_output(lines);
  } else {
    write_standard_output(report::analysis_text(analysed));
  }
}

}  // namespace

void add_analyze(CLI::App& app) {
  auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command = app.add_subcommand("analyze", "Critical stiffness, what limits it, and the margins of a wall");
  add_device_arguments(*command, options->devices, FileCount::several);
  command->add_flag("--json", options->json, "Print one JSON document per device, one per line");
  command->footer(
      "Examples:\n"
      "  zwidth analyze devices/lhifam.toml\n"
      "  zwidth analyze devices/lhifam.toml --set wall.stiffness=5000 --set wall.damping=5\n"
      "  zwidth analyze devices/lhifam.toml devices/lhifam_rigid.toml --json");
  command->callback([options] { run_analyze(*options); });
}

}  // namespace zwidth::cli
