#include "zwidth/workspace.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/refused_answer.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "cli/workspace_arguments.hpp"
#include "cli/workspace_series.hpp"
#include "report/figure/figures.hpp"
#include "report/text/text_medium.hpp"
#include "report/workspace_report.hpp"
#include "results/workspace_json.hpp"

namespace zwidth::cli {
namespace {

struct WorkspaceArguments {
  DeviceArguments devices;
  WorkspaceOptionTexts texts;
  std::optional<double> stiffness;
  std::size_t threads = 0;
  bool all_directions = false;
  std::string report;
  std::string worst;
  OutputArguments output;
};

constexpr const char* worst_option = "--worst-to";

/// The library's members as the options that set them.
constexpr std::pair<std::string_view, std::string_view> options_of_workspace[] = {
    {"grid", "--poses"},         {"poses", "--poses"},         {"points", "--points"},  {"normals", "--normals"},
    {"directions", "--normals"}, {"stiffness", "--stiffness"}, {"threads", "--threads"}};

/// Of an element, "grid.0.count", the option is that of the list.
OptionProblem of_whole_option(OptionProblem problem) {
  problem.member = problem.member.substr(0, problem.member.find('.'));
  return problem;
}

/// Empty where there is no file.
std::string folder_of(const std::string& file) {
  if (file.empty()) return {};
  return std::filesystem::absolute(file).lexically_normal().parent_path().string();
}

Workspace found_workspace(const CLI::App& command, const Device& device, WorkspaceOptions options,
                          const std::string& file) {
  ProgressLine line(command, "going through the workspace of " + file);
  options.progress = line.progress();
  return worked(
      file, [&] { return workspace(device, options); }, options_of_workspace);
}

void run_workspace(const WorkspaceArguments& arguments) {
  const CLI::App& command = *arguments.devices.command;
  const std::string& file = arguments.devices.files.front();
  Outputs outputs(command, arguments.output);
  outputs.add("--report", arguments.report, Ending::page);
  outputs.add(worst_option, arguments.worst);
  outputs.keep(arguments.devices.files, "device file");
  WorkspaceOptions options{.stiffness = arguments.stiffness, .threads = arguments.threads};
  apply(arguments.texts, options);
  if (const auto problem = find_problem(options)) refuse(of_whole_option(*problem), options_of_workspace);
  check_threads(command, "--threads", options.threads);
  const Device device = std::move(read_devices(arguments.devices).front());
  if (const auto problem = find_problem(options, device)) refuse(of_whole_option(*problem), options_of_workspace, file);
  outputs.keep(device.parameters().mechanism->mechanism.path, "mechanism's file");
  const Workspace found = found_workspace(command, device, options, file);
  hand_over_limits(command, found, options);
  const std::string answer =
      arguments.output.json
          ? results::line(results::workspace_json(
                device, found,
                arguments.all_directions ? results::DirectionsInJson::included : results::DirectionsInJson::left_out))
          : report::for_medium(report::workspace_text(device, found, arguments.output.findings));
  if (found.trust.refused()) {
    return print_refused(outputs, found.trust, device.name(), answer,
                         {arguments.output.csv, arguments.output.figure, arguments.report, arguments.worst});
  }
  if (!arguments.worst.empty() && !found.least) {
    throw WorkFailed("--worst-to: no limit is known at any pose: there is no worst one");
  }
  std::string worst;
  if (found.least && (!arguments.worst.empty() || request_of(command) != nullptr)) {
    worst = report::worst_pose_file(device, found, folder_of(arguments.worst));
    hand_over_device(command, worst);
  }
  outputs.put("--csv", [&] { return results::workspace_csv(found); });
  outputs.put("--report", [&] { return report::workspace_page(device, found); });
  outputs.put(worst_option, [&] { return worst; });
  outputs.draw("--output", [&](report::FigureFormat format) { return report::draw_workspace(device, found, format); });
  outputs.commit();
  outputs.print(answer);
}

}  // namespace

void add_workspace(CLI::App& app) {
  auto arguments = std::make_shared<WorkspaceArguments>();
  CLI::App* command = app.add_subcommand(
      "workspace", "The stiffest wall of a mechanism at every pose and in every direction: the least, where it is");
  add_device_arguments(*command, arguments->devices, FileCount::one);
  command
      ->add_option("--poses", arguments->texts.poses,
                   "JOINT=FIRST:LAST:COUNT or JOINT=VALUE, parted by commas, in rad or m,\n"
                   "or with a unit; parted by ; a list of poses (default: ranges in the\n"
                   "mechanism's file)")
      ->type_name("GRID")
      ->allow_extra_args(false);
  command
      ->add_option("--points", arguments->texts.points,
                   "Instead: points that the tip goes to, in m or with a unit; a semicolon\nparts them too")
      ->type_name("X,Y,Z");
  command
      ->add_option("--normals", arguments->texts.normals,
                   "Of the wall: a number of directions, spread and refined to the least,\n"
                   "or normals, \"1,0,0;0,1,0\" (default: 12 in a plane, 48 in space)")
      ->type_name("N|LIST")
      ->allow_extra_args(false);
  command
      ->add_option("--stiffness", arguments->stiffness, "Also the share of the workspace that renders this wall, N/m")
      ->type_name("K");
  command->add_option("--threads", arguments->threads, "0: all cores; no result depends on it (default: 0)")
      ->type_name("N");
  add_output_options(*command, arguments->output,
                     {.csv = "Also write a row for every pose and direction that was tried",
                      .figure = "Also draw a map: .svg, .png or .pdf",
                      .explain = explain_help});
  command->add_flag("--all-directions", arguments->all_directions,
                    "With --json: each pose's limits in all directions tried, too");
  command->add_option("--report", arguments->report, "Also write a page with the map: .html")->type_name("FILE");
  command
      ->add_option(worst_option, arguments->worst,
                   "Also write the device at the worst pose and normal, of any\npassive user where that is known")
      ->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  zwidth workspace devices/mechanisms/planar_arm.toml \\\n"
      "    --poses \"shoulder=0:90:4 deg,elbow=20:150:5 deg\" --stiffness \"0.5 kN/m\"\n"
      "  zwidth workspace devices/mechanisms/planar_arm.toml --points \"0.3,0.2,0; 350,100,0 mm\"\n"
      "  zwidth workspace devices/mechanisms/planar_arm.toml --points 0.3,0.2,0 \\\n"
      "    --normals \"1,0,0;0,1,0\" --json\n"
      "  zwidth workspace devices/mechanisms/planar_arm.toml \\\n"
      "    --poses \"shoulder=0.3,elbow=20:150:5 deg\" --output map.svg --worst-to worst.toml\n"
      "  zwidth workspace devices/mechanisms/planar_arm.toml --report workspace.html");
  command->callback([arguments] { run_workspace(*arguments); });
}

}  // namespace zwidth::cli
