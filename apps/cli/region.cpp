#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "cli/device_arguments.hpp"
#include "cli/outputs.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/device_region.hpp"
#include "report/figure/region_figure.hpp"
#include "report/text/region_text.hpp"
#include "results/region_csv.hpp"
#include "results/region_json.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

struct RegionArguments {
  DeviceArguments devices;
  std::string csv;
  std::string output;
  std::optional<std::size_t> raster;
  bool json = false;
};

report::DeviceRegion region_of(const DeviceArguments& arguments) {
  std::vector<Device> devices = read_devices(arguments);
  try {
    return report::device_region(std::move(devices.front()));
  } catch (const Error& error) {
    std::string message = arguments.files.front() + ": " + error.what();
    if (error.code() == ErrorCode::did_not_converge) {
      message += "; `zwidth analyze --set wall.damping=B` still gives the stable stiffnesses at one damping B";
    }
    throw WorkFailed(message);
  }
}

void run_region(const RegionArguments& arguments) {
  Outputs outputs;
  outputs.add("--csv", arguments.csv);
  outputs.add("--output", arguments.output, Ending::figure);
  outputs.keep(arguments.devices.files, "device file");
  if (arguments.raster && arguments.csv.empty()) throw BadInput("--raster: is for a csv file; add --csv FILE");
  const report::DeviceRegion device = region_of(arguments.devices);
  outputs.put("--csv", [&] {
    return arguments.raster ? report::region_raster_csv(device, *arguments.raster) : report::region_csv(device.region);
  });
  outputs.draw("--output", [&](report::FigureFormat format) { return report::draw_region(device, format); });
  outputs.commit();
  write_standard_output(arguments.json ? results::line(report::region_json(device)) : report::region_text(device));
}

}  // namespace

void add_region(CLI::App& app) {
  auto arguments = std::make_shared<RegionArguments>();
  CLI::App* command =
      app.add_subcommand("region", "Every stable wall, stiff and damped: the region in the plane of K and B");
  add_device_arguments(*command, arguments->devices, FileCount::one);
  command->add_flag("--json", arguments->json, "Print the region as one JSON document on one line");
  command->add_option("--csv", arguments->csv, "Also write the boundary's points")->type_name("FILE");
  command->add_option("--raster", arguments->raster, "With --csv: N x N walls, each stable or not, instead")
      ->type_name("N")
      ->check(CLI::Range(2, 2000));
  command->add_option("-o,--output", arguments->output, "Also draw a figure: .svg, .png or .pdf")->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  zwidth region devices/lhifam.toml\n"
      "  zwidth region devices/lhifam.toml --set wall.velocity_filter_hz=100 --output region.svg\n"
      "  zwidth region devices/lhifam.toml --set loop.delay=0.25e-3 --json --csv boundary.csv\n"
      "  zwidth region devices/lhifam.toml --raster 100 --csv map.csv");
  command->callback([arguments] { run_region(*arguments); });
}

}  // namespace zwidth::cli
