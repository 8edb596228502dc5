#include "zwidth/simulation/simulate.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/motion_arguments.hpp"
#include "cli/option_refusal.hpp"
#include "cli/option_units.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/recording_arguments.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/figures.hpp"
#include "report/text/simulation_text.hpp"
#include "results/simulation_json.hpp"
#include "results/trajectory_envelope.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {
namespace {

constexpr std::size_t most_drawn_points = 1000000;  // kept for a figure alone
constexpr std::size_t most_points_in_json = 20000;

struct SimulateArguments {
  DeviceArguments device;
  MotionArguments motion;
  std::optional<double> duration;
  std::string contact = "bilateral";
  std::optional<double> wall_position;
  double lost_samples = 0.0;
  double jitter = 0.0;
  std::vector<std::string> overrun;  // probability, seconds
  std::uint64_t seed = 1;
  double divergence = 1e3;
  std::size_t every = 1;
  bool points = false;  // of the motion, in the JSON document
  std::optional<std::size_t> envelope;
  OutputArguments output{.figure_option = "--figure"};
};

/// Options by the member of SimulationOptions that they set.
constexpr std::pair<std::string_view, std::string_view> options_of_simulation[] = {
    {"wall_position", "--wall-position"},
    {"contact", "--contact"},
    {"duration", "--duration"},
    {"keep_every", "--every"},
    {"divergence", "--divergence"},
    {"initial_position", "--start"},
    {"initial_velocity", "--start-velocity"},
    {"user_force", "--user-force"},
    {"user_force.start", "--user-force"},
    {"faults.lost_sample_probability", "--lost-samples"},
    {"faults.sampling_jitter", "--jitter"},
    {"faults.overrun_probability", "--overrun"},
    {"faults.overrun_delay", "--overrun"},
};

SimulationOptions options_of(const SimulateArguments& arguments, const Device& device) {
  SimulationOptions options;
  if (arguments.contact == "unilateral") options.contact = ControllerOptions::Contact::unilateral;
  options.wall_position = arguments.wall_position;
  options.faults = {arguments.lost_samples, arguments.jitter, 0.0, 0.0, arguments.seed};
  if (!arguments.overrun.empty()) {
    const Motion motion = device.parameters().motion;
    options.faults.overrun_probability = measured_number("--overrun", arguments.overrun[0], Measure::ratio, motion);
    options.faults.overrun_delay = measured_number("--overrun", arguments.overrun[1], Measure::time, motion);
  }
  apply(arguments.motion, device, options);
  options.duration = arguments.duration;
  options.divergence = arguments.divergence;
  const bool has_figure = !arguments.output.figure.empty();
  const bool has_table = !arguments.output.csv.empty();
  options.keep_every = has_table || has_figure || arguments.points ? arguments.every : 0;
  const bool is_thinned_evenly = arguments.points && !arguments.envelope;
  if (!has_table) options.keep_at_most = is_thinned_evenly ? most_points_in_json : most_drawn_points;
  if (const auto problem = find_problem(options, device)) refuse(*problem, options_of_simulation);
  check_samples(*arguments.device.command, "--duration",
                options.duration.value_or(0.0) / device.loop().sampling_period);
  return options;
}

void run_simulate(const SimulateArguments& arguments) {
  Outputs outputs(*arguments.device.command, arguments.output);
  outputs.keep(arguments.device.files, "device file");
  outputs.keep(arguments.motion.user_force, "recording");
  const Device device = read_devices(arguments.device).front();
  const std::string& file = arguments.device.files.front();
  Simulation result = worked(file, [&] {
    const SimulationOptions options = options_of(arguments, device);
    ProgressLine line(*arguments.device.command, "simulating " + file);
    return simulate(device, options, line.progress());
  });
  outputs.put("--csv", [&] { return results::simulation_csv(device, result); });
  outputs.draw("--figure",
               [&](report::FigureFormat format) { return report::draw_simulation_figure(device, result, format); });
  outputs.commit();
  if (arguments.output.json) {
    if (arguments.envelope) result.trajectory = results::envelope_of(result.trajectory, *arguments.envelope);
    const auto points = arguments.points ? results::PointsInJson::included : results::PointsInJson::left_out;
    outputs.print(results::line(results::simulation_json(device, result, points)));
  } else {
    outputs.print_text(report::simulation_text(device, result));
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
      ->type_name("M");
  command
      ->add_option("--divergence", arguments->divergence, "End the run as unstable this far from the start, m or rad")
      ->type_name("M")
      ->capture_default_str();
  add_output_options(*command, arguments->output,
                     {.csv = "Also write the motion", .figure = "Also draw the motion: .svg, .png or .pdf"});
  command->add_option("--every", arguments->every, "Keep every N-th sample for --csv, --figure and --points")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000000));
  command->add_flag("--points", arguments->points, "With --json: the motion too, thinned to 20000 points")
      ->needs("--json");
  command
      ->add_option("--envelope", arguments->envelope,
                   "With --points: so many at most, those with the peaks between them,\nfor a picture")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{100}, most_points_in_json))
      ->needs("--points");
  add_motion_arguments(*command, arguments->motion);
  add_fault_options(*command, *arguments);
  command->footer(
      "Without any motion every body starts at rest 1 mm (1 mrad) inside the wall, further in where\n"
      "friction or the encoder would hide that.\n"
      "\n"
      "Examples:\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=5000\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=5000 --set body.motor.coulomb=0.5 --json\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=8000 --contact unilateral \\\n"
      "    --user-force step:5@0.1\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=9000 --figure grows.svg --csv grows.csv\n"
      "  zwidth simulate devices/lhifam.toml --set wall.stiffness=5000 --lost-samples 0.05 --jitter 2e-4");
  command->callback([arguments, command] {
    if (command->count("--every") > 0 && arguments->output.csv.empty() && arguments->output.figure.empty() &&
        !arguments->points) {
      throw BadInput("--every", "is for --csv, --figure and --points", "add one");
    }
    run_simulate(*arguments);
  });
}

}  // namespace zwidth::cli
