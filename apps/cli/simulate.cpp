#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/motion_arguments.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/recording_arguments.hpp"
#include "cli/remark_lines.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/simulation_figure.hpp"
#include "report/simulated_loop.hpp"
#include "report/text/simulation_text.hpp"
#include "results/simulation_csv.hpp"
#include "results/simulation_json.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

constexpr double default_offset = 1e-3;    // m or rad, of a device that nothing else moves
constexpr double least_duration = 1.0;     // s
constexpr double default_periods = 40.0;   // of the critical oscillation
constexpr double default_samples = 1e6;    // at most
constexpr double most_rows = 5e6;          // of a CSV file
constexpr double most_drawn_points = 1e6;  // kept for a figure alone

struct SimulateArguments {
  DeviceArguments device;
  MotionArguments motion;
  std::optional<double> duration;
  std::string contact = "bilateral";
  std::optional<double> wall_position;
  double lost_samples = 0.0;
  double jitter = 0.0;
  std::vector<double> overrun;  // probability, seconds
  std::uint64_t seed = 1;
  double divergence = 1e3;
  std::size_t every = 1;
  std::string csv;
  std::string figure;
  bool json = false;
};

void check_at_least_zero(std::string_view option, double value, std::string_view unit) {
  if (!(std::isfinite(value) && value >= 0.0)) {
    throw BadInput(fmt::format("{}: is {}; a number of {} >= 0", option, value, unit));
  }
}

void check_probability(std::string_view option, double value) {
  if (!(value >= 0.0 && value <= 1.0)) throw BadInput(fmt::format("{}: is {}; a share from 0 to 1", option, value));
}

Faults faults_of(const SimulateArguments& arguments, const Device& device) {
  const double period = device.loop().sampling_period;
  check_probability("--lost-samples", arguments.lost_samples);
  check_at_least_zero("--jitter", arguments.jitter, "s");
  if (arguments.jitter >= period) {
    throw BadInput(fmt::format("--jitter: is {} s; below the sampling period, {} s", arguments.jitter, period));
  }
  Faults faults;
  faults.lost_sample_probability = arguments.lost_samples;
  faults.sampling_jitter = arguments.jitter;
  faults.seed = arguments.seed;
  if (!arguments.overrun.empty()) {
    check_probability("--overrun", arguments.overrun[0]);
    check_at_least_zero("--overrun", arguments.overrun[1], "s");
    if (arguments.overrun[1] > max_delay_samples * period) {
      throw BadInput(fmt::format("--overrun: {} s late; at most {} s, {} sampling periods", arguments.overrun[1],
                                 max_delay_samples * period, max_delay_samples));
    }
    faults.overrun_probability = arguments.overrun[0];
    faults.overrun_delay = arguments.overrun[1];
  }
  return faults;
}

ControllerOptions controller_of(const SimulateArguments& arguments, const Device& device) {
  const Wall& wall = device.parameters().wall;
  ControllerOptions controller = wall_controller(wall);
  if (!wall.stiffness && wall.damping == 0.0) controller.kind = ControllerOptions::Kind::none;
  controller.position = arguments.wall_position.value_or(0.0);
  if (!std::isfinite(controller.position)) {
    throw BadInput(fmt::format("--wall-position: is {}; a number of m or rad", controller.position));
  }
  if (arguments.contact == "unilateral") controller.contact = ControllerOptions::Contact::unilateral;
  return controller;
}

/// Sets a device in motion that nothing else moves: 1 mm (1 mrad) inside the wall.
void start_inside_the_wall(HybridLoopOptions& options, const SimulateArguments& arguments, const Device& device) {
  if (options.controller.stiffness == 0.0) {
    throw BadInput(
        "nothing moves the device: add a wall (--set wall.stiffness=5000), --start, --start-velocity or --user-force");
  }
  if (options.controller.contact == ControllerOptions::Contact::unilateral) {
    throw BadInput(
        "--contact unilateral: nothing presses the device against the wall; add --user-force step:5, --start or "
        "--start-velocity");
  }
  if (device.has_bodies()) {
    options.initial_position.assign(device.bodies().size(), options.controller.position + default_offset);
  } else if (!arguments.wall_position) {
    options.controller.position = -default_offset;
  }
}

void check_motion(const HybridLoopOptions& options, const Device& device) {
  const auto is_zero = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
  };
  const bool pushed =
      options.controller.kind == ControllerOptions::Kind::wall && options.controller.position != 0.0 &&
      (options.controller.contact == ControllerOptions::Contact::bilateral || options.controller.position < 0.0);
  if (!pushed && options.user_force.kind == UserForce::Kind::none && is_zero(options.initial_position) &&
      is_zero(options.initial_velocity)) {
    throw BadInput(device.has_bodies()
                       ? "--start: every body starts at rest at 0, where nothing moves it; a number but 0"
                       : "--wall-position: is 0, where nothing moves the device; a number but 0");
  }
}

double duration_of(const SimulateArguments& arguments, const report::AnalysedDevice& analysed, const UserForce& force) {
  const Loop& loop = analysed.device.loop();
  if (!arguments.duration) {
    double duration = std::max(least_duration, 4.0 * loop.delay);
    const auto& limit = analysed.analysis.critical.limit;
    if (limit && limit->frequency > 0.0) {
      duration = std::max(duration, default_periods * 2.0 * std::numbers::pi / limit->frequency);
    }
    return std::min(duration, default_samples * loop.sampling_period) + force.start;
  }
  const double duration = *arguments.duration;
  const double samples = std::round(duration / loop.sampling_period);
  if (!(samples >= 1.0 && samples <= max_simulated_samples)) {
    throw BadInput(fmt::format("--duration: is {} s; {} s to {} s, 1 to {} sampling periods", duration,
                               loop.sampling_period, max_simulated_samples * loop.sampling_period,
                               max_simulated_samples));
  }
  if (loop.delay >= duration) {
    throw BadInput(fmt::format("--duration: is {} s, not longer than the loop's delay of {} s: no force would arrive",
                               duration, loop.delay));
  }
  if (force.start >= duration) {
    throw BadInput(fmt::format("--duration: is {} s; the user's force begins at {} s only", duration, force.start));
  }
  return duration;
}

std::size_t kept_points(const SimulateArguments& arguments, double samples) {
  if (!arguments.csv.empty()) {
    if (samples / static_cast<double>(arguments.every) > most_rows) {
      throw BadInput(fmt::format("--csv: would have {:.0f} rows; at most {:.0f}: thin them with --every N",
                                 samples / static_cast<double>(arguments.every), most_rows));
    }
    return arguments.every;
  }
  if (arguments.figure.empty()) return 0;
  return std::max(arguments.every, static_cast<std::size_t>(std::ceil(samples / most_drawn_points)));
}

SimulationOptions options_of(const SimulateArguments& arguments, const report::AnalysedDevice& analysed) {
  const Device& device = analysed.device;
  SimulationOptions options;
  options.loop.controller = controller_of(arguments, device);
  options.loop.faults = faults_of(arguments, device);
  apply(arguments.motion, device, options.loop);
  options.duration = duration_of(arguments, analysed, options.loop.user_force);
  if (!(std::isfinite(arguments.divergence) && arguments.divergence > 0.0)) {
    throw BadInput(fmt::format("--divergence: is {}; a number of m or rad above 0", arguments.divergence));
  }
  options.divergence = arguments.divergence;
  options.keep_every = kept_points(arguments, std::round(options.duration / device.loop().sampling_period));
  if (is_empty(arguments.motion)) start_inside_the_wall(options.loop, arguments, device);
  check_motion(options.loop, device);
  return options;
}

report::SimulatedLoop simulated(const report::AnalysedDevice& analysed, const SimulationOptions& options,
                                const std::string& file) {
  ProgressLine line("simulating " + file);
  try {
    return report::simulated_loop(analysed, options, line.progress());
  } catch (const Error& error) {
    throw BadInput(file + ": " + error.what());
  }
}

void run_simulate(const SimulateArguments& arguments) {
  Outputs outputs;
  outputs.add("--csv", arguments.csv);
  outputs.add("--figure", arguments.figure, Ending::figure);
  outputs.keep(arguments.device.files, "device file");
  outputs.keep(arguments.motion.user_force, "recording");
  const report::AnalysedDevice analysed = analyze_devices(arguments.device, limit_and_wall_only()).front();
  const SimulationOptions options = options_of(arguments, analysed);
  const report::SimulatedLoop loop = simulated(analysed, options, arguments.device.files.front());
  outputs.put("--csv", [&] { return report::simulation_csv(loop); });
  outputs.draw("--figure", [&](report::FigureFormat format) { return report::draw_simulation_figure(loop, format); });
  outputs.commit();
  if (arguments.json) {
    write_warnings(loop.remarks);
    write_standard_output(results::line(report::simulation_json(loop)));
  } else {
    write_standard_output(report::simulation_text(loop));
  }
}

void add_fault_options(CLI::App& command, SimulateArguments& arguments) {
  constexpr const char* group = "Faults of the controller";
  command.add_option("--lost-samples", arguments.lost_samples, "Share of samples that are lost: the last force stays")
      ->type_name("P")
      ->group(group);
  command.add_option("--jitter", arguments.jitter, "Each sample is late by a random part of so many s")
      ->type_name("S")
      ->group(group);
  command
      .add_option("--overrun", arguments.overrun,
                  "Share of forces that are late, and by how many s; one that a\nnewer force overtakes is lost")
      ->type_name("P,S")
      ->delimiter(',')
      ->expected(2)
      ->group(group);
  command.add_option("--seed", arguments.seed, "Of the random faults")
      ->type_name("N")
      ->capture_default_str()
      ->group(group);
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand("simulate", "The sampled loop in time: friction, encoder, faults, user, wall");
  add_device_arguments(*command, arguments->device, FileCount::one);
  command
      ->add_option("--duration", arguments->duration,
                   "Seconds; else 40 periods of the critical oscillation, at least 1 s")
      ->type_name("S");
  command
      ->add_option("--contact", arguments->contact,
                   "bilateral: a spring on both sides, as analyze takes it;\nunilateral: the wall only pushes")
      ->type_name("KIND")
      ->capture_default_str()
      ->check(CLI::IsMember({"bilateral", "unilateral"}));
  command
      ->add_option("--wall-position", arguments->wall_position, "Where the wall begins, m or rad; it fills all beyond")
      ->type_name("X");
  command
      ->add_option("--divergence", arguments->divergence, "End the run as unstable this far from the start, m or rad")
      ->type_name("X")
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print one JSON document on one line");
  command->add_option("--csv", arguments->csv, "Also write the motion")->type_name("FILE");
  command->add_option("--figure", arguments->figure, "Also draw the motion: .svg, .png or .pdf")->type_name("FILE");
  command->add_option("--every", arguments->every, "Keep every N-th sample for --csv and --figure")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000000));
  add_motion_arguments(*command, arguments->motion);
  add_fault_options(*command, *arguments);
  command->footer(
      "Without any motion every body starts at rest 1 mm (1 mrad) inside the wall.\n"
      "\n"
      "Examples:\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=5000\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=5000 --set body.motor.coulomb=0.5 --json\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=8000 --contact unilateral \\\n"
      "    --user-force step:5@0.1\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=9000 --figure grows.svg --csv grows.csv\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=5000 --lost-samples 0.05 --jitter 2e-4");
  command->callback([arguments, command] {
    if (command->count("--every") > 0 && arguments->csv.empty() && arguments->figure.empty()) {
      throw BadInput("--every: is for --csv and --figure; add one");
    }
    run_simulate(*arguments);
  });
}

}  // namespace zwidth::cli
