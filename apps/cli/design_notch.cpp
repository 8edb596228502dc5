#include "cli/design_notch.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/refused_answer.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/figures.hpp"
#include "report/text/design_text.hpp"
#include "report/text/text_medium.hpp"
#include "results/design_json.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array options_of_notch{"--goal",           "--drift-percent",  "--gain-margin-db", "--phase-margin-deg",
                                      "--far-from-modes", "--lower-any-user", "--write"};

NotchOptions notch_options(const NotchArguments& arguments) {
  NotchOptions options;
  if (arguments.goal == "any-user") options.goal = StiffnessGoal::absolute_stability_limit;
  if (arguments.goal && *arguments.goal != "any-user" && *arguments.goal != "critical-stiffness") {
    throw BadInput("--goal", fmt::format("{} is not for a notch", *arguments.goal),
                   "critical-stiffness or any-user is");
  }
  if (arguments.drift_percent) options.modal_frequency_uncertainty = *arguments.drift_percent / 100.0;
  if (arguments.gain_margin_db) options.gain_margin = ratio_of_decibels(*arguments.gain_margin_db);
  if (arguments.phase_margin_deg) options.phase_margin = radians(*arguments.phase_margin_deg);
  options.far_from_modes = arguments.far_from_modes;
  options.lower_absolute_stability_limit = arguments.lower_absolute_stability_limit;
  return options;
}

constexpr std::pair<std::string_view, std::string_view> options_of_notch_design[] = {
    {"modal_frequency_uncertainty", "--drift-percent"},
    {"gain_margin", "--gain-margin-db"},
    {"phase_margin", "--phase-margin-deg"},
    {"goal", "--goal"},
    {"notch", "--notch"}};

NotchDesign designed(const CLI::App& command, const Device& device, NotchOptions options, const std::string& file) {
  if (const auto problem = find_problem(options, device)) refuse(*problem, options_of_notch_design, file);
  ProgressLine line(command, "designing the notch");
  options.progress = line.progress();
  return worked(file, [&] { return design_notch(device, options); });
}

}  // namespace

void add_notch_options(CLI::App& command, NotchArguments& arguments) {
  const char* group = "Notch";
  command.add_flag("--notch", arguments.wanted, "Design the notch in the wall's force that makes the wall stiffest")
      ->group(group);
  command
      .add_option("--goal", arguments.goal,
                  "Of a notch: critical-stiffness (default), any-user.\n"
                  "Of --recommend: stiffness (default), width,\n"
                  "critical-damping, damper (alone, K = 0).\n"
                  "Of --target: stiffness (default), damper")
      ->check(CLI::IsMember({"critical-stiffness", "any-user", "stiffness", "width", "critical-damping", "damper"}))
      ->type_name("GOAL")
      ->group(group);
  command.add_option("--drift-percent", arguments.drift_percent, "How far the modes' frequencies may shift, both ways")
      ->type_name("P")
      ->group(group);
  command
      .add_option("--gain-margin-db", arguments.gain_margin_db,
                  "Least gain margin, of K alone and of the whole force (default 6.02)")
      ->type_name("DB")
      ->group(group);
  command
      .add_option("--phase-margin-deg", arguments.phase_margin_deg,
                  "Least phase margin of the designed or recommended wall (default 30)")
      ->type_name("DEG")
      ->group(group);
  command.add_flag("--far-from-modes", arguments.far_from_modes, "The filter may lie far from every mode: a lag")
      ->group(group);
  command
      .add_flag("--lower-any-user", arguments.lower_absolute_stability_limit,
                "The notch may lower the limit with any passive user")
      ->group(group);
  command.add_option("--write", arguments.write, "Write the device file with the notch and the wall in it")
      ->type_name("FILE")
      ->group(group);
}

void refuse_notch_options(const CLI::App& command, bool goal_is_used) {
  for (const std::string_view option : options_of_notch) {
    if (goal_is_used && option == "--goal") continue;
    if (command.count(std::string(option)) > 0)
      throw BadInput(option, "is for a notch or a recommendation", "add --notch or --recommend");
  }
}

void run_notch(const DeviceArguments& devices, const NotchArguments& arguments, const OutputArguments& output) {
  Outputs outputs(*devices.command);
  outputs.add(output);
  outputs.add("--write", arguments.write);
  outputs.keep(devices.files, "device file");
  const Device device = read_devices(devices).front();
  const NotchOptions options = notch_options(arguments);
  const NotchDesign notch = designed(*devices.command, device, options, devices.files.front());
  if (notch.trust.refused()) {
    return print_refused(outputs, notch.trust, device.name(),
                         output.json ? results::line(results::notch_json(device, options, notch)) : "",
                         {arguments.write, output.figure});
  }
  if (!arguments.write.empty() && !notch.state_with) {
    throw WorkFailed("no notch makes the wall stiffer: " + arguments.write + " is not written");
  }
  outputs.put("--write", [&] { return write_device(notch.state_with->device.parameters()); });
  outputs.draw("--output",
               [&](report::FigureFormat format) { return report::draw_notch(device, options, notch, format); });
  outputs.commit();
  outputs.print(output.json ? results::line(results::notch_json(device, options, notch))
                            : report::for_medium(report::notch_text(device, options, notch)));
}

}  // namespace zwidth::cli
