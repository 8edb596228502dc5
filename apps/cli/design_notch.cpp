#include "cli/design_notch.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/designed_notch.hpp"
#include "results/design_json.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array options_of_notch{"--goal", "--drift-percent", "--gain-margin-db", "--phase-margin-deg", "--write"};

NotchOptions notch_options(const NotchArguments& arguments) {
  const auto require_number = [](const char* option, double value) {
    if (!std::isfinite(value)) throw BadInput(fmt::format("{}: is {}; a number", option, value));
  };
  require_number("--drift-percent", arguments.drift_percent);
  require_number("--gain-margin-db", arguments.gain_margin_db);
  require_number("--phase-margin-deg", arguments.phase_margin_deg);
  NotchOptions options;
  if (arguments.goal == "any-user") options.goal = StiffnessGoal::any_user_limit;
  options.drift = arguments.drift_percent / 100.0;
  options.gain_margin = std::pow(10.0, arguments.gain_margin_db / 20.0);
  options.phase_margin = arguments.phase_margin_deg * std::numbers::pi / 180.0;
  return options;
}

report::DesignedNotch designed(const Device& device, NotchOptions options, const std::string& file) {
  ProgressLine line("designing the notch");
  options.progress = line.progress();
  try {
    return report::designed_notch(device, options);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::did_not_converge) throw WorkFailed(file + ": " + error.what());
    throw BadInput(file + ": " + error.what());
  }
}

}  // namespace

void add_notch_options(CLI::App& command, NotchArguments& arguments) {
  const char* group = "Notch";
  command.add_flag("--notch", arguments.wanted, "Design the notch in the wall's force that makes the wall stiffest")
      ->group(group);
  command.add_option("--goal", arguments.goal, "What it is to raise: critical-stiffness (default) or any-user")
      ->check(CLI::IsMember({"critical-stiffness", "any-user"}))
      ->type_name("GOAL")
      ->group(group);
  command.add_option("--drift-percent", arguments.drift_percent, "How far the modes' frequencies may shift, both ways")
      ->type_name("P")
      ->check(CLI::Range(0.0, 90.0))
      ->group(group);
  command.add_option("--gain-margin-db", arguments.gain_margin_db, "Least gain margin of the designed wall")
      ->type_name("DB")
      ->check(CLI::Range(0.0, 100.0))
      ->group(group);
  command.add_option("--phase-margin-deg", arguments.phase_margin_deg, "Least phase margin of the designed wall")
      ->type_name("DEG")
      ->check(CLI::Range(0.0, 90.0))
      ->group(group);
  command.add_option("--write", arguments.write, "Write the device file with the notch (and the designed wall) in it")
      ->type_name("FILE")
      ->group(group);
}

void refuse_notch_options(const CLI::App& command) {
  for (const char* option : options_of_notch) {
    if (command.count(option) > 0) throw BadInput(fmt::format("{}: is for a notch; add --notch", option));
  }
}

void run_notch(const DeviceArguments& devices, const NotchArguments& arguments, const NotchOutput& output) {
  Outputs outputs;
  outputs.add("--output", output.figure, Ending::figure);
  outputs.add("--write", arguments.write);
  outputs.keep(devices.files, "device file");
  const std::vector<Device> read = read_devices(devices);
  const report::DesignedNotch notch = designed(read.front(), notch_options(arguments), devices.files.front());
  if (!arguments.write.empty()) {
    if (!notch.with) throw WorkFailed("no notch makes the wall stiffer: " + arguments.write + " is not written");
  }
  outputs.put("--write", [&] { return write_device(notch.with->device.parameters()); });
  outputs.draw("--output", [&](report::FigureFormat format) { return report::draw_notch(notch, format); });
  outputs.commit();
  write_standard_output(output.json ? results::line(results::notch_json(notch)) : report::notch_text(notch));
}

}  // namespace zwidth::cli
