#include "zwidth/design/region.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/refused_answer.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/figures.hpp"
#include "report/text/region_text.hpp"
#include "report/text/text_medium.hpp"
#include "results/region_json.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/design/wall_summary.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth::cli {
namespace {

struct RegionArguments {
  DeviceArguments devices;
  OutputArguments output;
  std::optional<std::size_t> raster;
  bool one_rate = false;
  report::Detail detail;
};

/// Bound to its progress line, which is gone before anything is printed.
WallRegion found_region(const CLI::App& command, const Device& device, const std::string& file) {
  ProgressLine line(command, "following the boundary of " + file);
  return region(device, {.progress = line.progress()});
}

/// The wall to mark in the figure; none where there is none, the search would take seconds, the damper runs apart, or the wall
/// acts in every direction.
std::optional<Wall> recommended_wall(const Device& device) {
  if (is_point_wall(device) || device.degrees_of_freedom() > most_bodies_for_wall_summary ||
      has_damper_loop(device.loop()))
    return std::nullopt;
  const WallRecommendation found = recommend_wall(device, {.alternatives = false});
  return found.wall && !found.trust.refused() ? std::optional(found.wall->wall) : std::nullopt;
}

/// Spring and damper both at the slower of two rates: what a damper of its own is drawn against.
std::optional<WallRegion> region_of_slower_rate(const Device& device) {
  if (!has_damper_loop(device.loop())) return std::nullopt;
  return region(at_slower_rate(device), {.any_user = false, .approximations = false});
}

void run_region(const RegionArguments& arguments) {
  Outputs outputs(*arguments.devices.command, arguments.output);
  outputs.keep(arguments.devices.files, "device file");
  if (arguments.raster && arguments.output.csv.empty())
    throw BadInput("--raster", "is for a csv file", "add --csv FILE");
  const Device read = std::move(read_devices(arguments.devices).front());
  const Device device = arguments.one_rate ? at_slower_rate(read) : read;
  const std::string& file = arguments.devices.files.front();
  const WallRegion walls = worked(file, [&] { return found_region(*arguments.devices.command, device, file); });
  if (walls.trust.refused()) {
    return print_refused(outputs, walls.trust, device.name(),
                         arguments.output.json ? results::line(results::region_json(device, walls)) : "",
                         {arguments.output.csv, arguments.output.figure});
  }
  outputs.put("--csv", [&] {
    return arguments.raster ? results::region_raster_csv(wall_raster(walls, *arguments.raster), walls.trust)
                            : results::region_csv(walls);
  });
  outputs.draw("--output", [&](report::FigureFormat format) {
    const auto slower = region_of_slower_rate(device);
    return report::draw_region(device, walls, format, recommended_wall(device), slower ? &*slower : nullptr);
  });
  outputs.commit();
  outputs.print(arguments.output.json ? results::line(results::region_json(device, walls))
                                      : report::for_medium(report::region_text(device, walls, arguments.detail)));
}

}  // namespace

void add_region(CLI::App& app) {
  auto arguments = std::make_shared<RegionArguments>();
  CLI::App* command =
      app.add_subcommand("region", "Every stable wall, stiff and damped: the region in the plane of K and B");
  add_device_arguments(*command, arguments->devices, FileCount::one);
  add_output_options(*command, arguments->output,
                     {.csv = "Also write the boundary's points", .figure = "Also draw a figure: .svg, .png or .pdf"});
  command->add_option("--raster", arguments->raster, "With --csv: N x N walls, each stable or not, instead")
      ->type_name("N")
      ->check(CLI::Range(2, 2000));
  command->add_flag("--one-rate", arguments->one_rate,
                    "With [loop.damper]: spring and damper at the slower of the two rates");
  command->add_flag("--formulas", arguments->detail.formulas, "Print the formulas of the literature beside the region");
  command->footer(
      "Examples:\n"
      "  zwidth region devices/lhifam.toml\n"
      "  zwidth region devices/lhifam.toml --set wall.velocity_filter_hz=100 --output region.svg\n"
      "  zwidth region devices/lhifam.toml --set loop.delay=0.25e-3 --json --csv boundary.csv\n"
      "  zwidth region devices/lhifam.toml --raster 100 --csv map.csv");
  command->callback([arguments] { run_region(*arguments); });
}

}  // namespace zwidth::cli
