#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/recording_arguments.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/relay_figure.hpp"
#include "report/relay_report.hpp"
#include "report/text/relay_text.hpp"
#include "results/relay_csv.hpp"
#include "results/relay_json.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

struct RelayArguments {
  DeviceArguments devices;
  RecordingArguments recording;
  RelayExperimentOptions experiment;  ///< what needs no translation is parsed straight into it
  double delay = 0.0;                 ///< s, added to the device's
  std::string motion = "linear";
  std::string csv;
  std::string figure;
  bool json = false;
};

constexpr const char* simulation_group = "Simulation";

bool is_at_least_zero(double value) { return std::isfinite(value) && value >= 0.0; }

void check(std::string_view option, bool holds, double value, std::string_view allowed) {
  if (!holds) throw BadInput(fmt::format("{}: is {}; {}", option, value, allowed));
}

void check_numbers(const RelayArguments& arguments) {
  const RelayExperimentOptions& experiment = arguments.experiment;
  check("--hysteresis", is_at_least_zero(experiment.relay.hysteresis), experiment.relay.hysteresis,
        "a position in m or rad, 0 or more");
  check("--delay", is_at_least_zero(arguments.delay), arguments.delay, "seconds, 0 or more");
  const double tolerance = experiment.analysis.steady_tolerance;
  check("--steady", tolerance > 0.0 && tolerance < 1.0, tolerance, "a relative difference above 0, below 1");
}

void check_simulation(const RelayArguments& arguments, const Device& device) {
  const RelayExperimentOptions& experiment = arguments.experiment;
  const double amplitude = experiment.relay.amplitude;
  check("--amplitude", std::isfinite(amplitude) && amplitude > 0.0, amplitude, "a force in N or N m above 0");
  const auto limit = device.parameters().actuator.force_limit;
  check("--amplitude", !limit || amplitude <= *limit, amplitude,
        fmt::format("at most the device's actuator.force_limit, {}", limit.value_or(0.0)));
  check("--start", std::isfinite(experiment.start_offset), experiment.start_offset, "a position in m or rad");
  check("--start", device.has_bodies() || experiment.start_offset == 0.0, experiment.start_offset,
        "a transfer function starts at rest at 0");
  check("--variation", experiment.variation >= 0.0 && experiment.variation < 1.0, experiment.variation,
        "a relative variation, 0 up to, but not including, 1");
  check("--duration", std::isfinite(experiment.duration) && experiment.duration > 0.0, experiment.duration,
        "seconds above 0");
  const double samples = std::round(experiment.duration / device.loop().sampling_period);
  if (samples < least_relay_samples || samples * static_cast<double>(experiment.trials) > most_relay_samples) {
    throw BadInput(fmt::format("--duration: {} trials of {} s are {:.6g} samples each; at least {}, at most {} in all",
                               experiment.trials, experiment.duration, samples, least_relay_samples,
                               most_relay_samples));
  }
  if (device.loop().delay >= experiment.duration) {
    throw BadInput(fmt::format("--duration: {} s is no longer than the loop's delay of {} s; a longer run",
                               experiment.duration, device.loop().delay));
  }
}

/// The device with the delay added; nothing where no file is given.
std::optional<Device> delayed_device(const RelayArguments& arguments) {
  if (arguments.devices.files.empty()) return std::nullopt;
  DeviceParameters parameters = read_devices(arguments.devices).front().parameters();
  parameters.loop.delay += arguments.delay;
  if (const auto problem = find_problem(parameters)) {
    throw BadInput(fmt::format("--delay: {} {}; {}", problem->key, problem->what, problem->allowed));
  }
  return Device(std::move(parameters));
}

report::RelayReport simulated(const RelayArguments& arguments, Device device) {
  check_simulation(arguments, device);
  report::RelayReport report;
  report.motion = device.parameters().motion;
  report.sampling_period = device.loop().sampling_period;
  report.relay = arguments.experiment.relay;
  ProgressLine line("simulating");
  report.trials = relay_experiment(device, arguments.experiment, line.progress());
  report.device = std::move(device);
  return report;
}

report::RelayReport recorded(const RelayArguments& arguments, std::optional<Device> device) {
  RecordedMotion motion = read_motion(arguments.recording);
  if (motion.output != OutputQuantity::position) {
    throw BadInput("--velocity, --acceleration: a relay acts on the position; name its column with --position");
  }
  report::RelayReport report;
  report.source = report::RelayReport::Source::recording;
  report.recording = motion.recording.source;
  report.motion =
      device ? device->parameters().motion : (arguments.motion == "rotary" ? Motion::rotary : Motion::linear);
  report.sampling_period = motion.recording.sampling_period;
  if (device) {
    const double expected = device->loop().sampling_period;
    if (std::abs(report.sampling_period / expected - 1.0) > 0.01) {
      throw BadInput(fmt::format("{}: loop.sampling_period: is {} s, the recording's is {:.6g} s; they must agree",
                                 arguments.devices.files.front(), expected, report.sampling_period));
    }
  }
  RelayTrial trial;
  trial.force = motion.force();
  trial.position = motion.motion();
  trial.result =
      analyse_relay_record(trial.force, trial.position, report.sampling_period, arguments.experiment.analysis);
  const auto [lowest, highest] = std::minmax_element(trial.force.begin(), trial.force.end());
  report.relay = {0.5 * (*highest - *lowest), arguments.experiment.relay.hysteresis};
  report.trials.push_back(std::move(trial));
  report.remarks = std::move(motion.recording.remarks);
  report.device = std::move(device);
  return report;
}

std::string drawn(const report::RelayReport& report, report::FigureFormat format) {
  const auto oscillates = [](const RelayTrial& trial) { return trial.result.has_value(); };
  auto shown = std::find_if(report.trials.begin(), report.trials.end(), oscillates);
  if (shown == report.trials.end()) shown = report.trials.begin();
  const std::string name = report.device ? report.device->name() : report.recording;
  const std::string title = report.trials.size() == 1 ? fmt::format("Relay experiment: {}", name)
                                                      : fmt::format("Relay experiment, trial {}: {}",
                                                                    shown - report.trials.begin() + 1, name);
  return draw_relay_record(title, *shown, report.sampling_period, report.motion, format);
}

void run_relay(const RelayArguments& arguments) {
  Outputs outputs;
  outputs.add("--csv", arguments.csv);
  outputs.add("--figure", arguments.figure, Ending::figure);
  outputs.keep(arguments.devices.files, "device file");
  outputs.keep(arguments.recording.file, "recording");
  check_numbers(arguments);
  std::optional<Device> device = delayed_device(arguments);
  report::RelayReport report = arguments.recording.file.empty() ? simulated(arguments, *std::move(device))
                                                                : recorded(arguments, std::move(device));
  if (report.device && report.relay.amplitude > 0.0) {
    report.prediction = relay_prediction(*report.device, report.relay);
  }
  outputs.put("--csv", [&] { return relay_csv(report); });
  outputs.draw("--figure", [&](report::FigureFormat format) { return drawn(report, format); });
  outputs.commit();
  write_standard_output(arguments.json ? results::line(relay_json(report)) : relay_text(report));
}

/// Options of what is not done would be ignored: refused instead.
void check_options(const CLI::App& command, const RelayArguments& arguments) {
  const bool is_recorded = !arguments.recording.file.empty();
  const bool has_device = !arguments.devices.files.empty();
  if (!is_recorded && !has_device) {
    throw BadInput("FILE: missing; a device file to simulate, or a recording with --recording");
  }
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string& name = option->get_name();
    if (!is_recorded && option->get_group() == recording_group) {
      throw BadInput(fmt::format("{}: is about a recording; add --recording FILE", name));
    }
    if (is_recorded && option->get_group() == simulation_group) {
      throw BadInput(fmt::format("{}: is about a simulation; leave out --recording", name));
    }
    const bool needs_device = name == "--delay" || name == "--hysteresis" || name == "--set";
    if (!has_device && needs_device) throw BadInput(fmt::format("{}: is about a device; add its file", name));
    if (has_device && name == "--motion") throw BadInput("--motion: the device file says it; leave out the option");
  }
  if (!is_recorded && command.count("--amplitude") == 0) {
    throw BadInput("--amplitude: missing; the relay's force in N or N m");
  }
}

void add_simulation_options(CLI::App& command, RelayArguments& arguments) {
  RelayExperimentOptions& experiment = arguments.experiment;
  command.add_option("--amplitude", experiment.relay.amplitude, "Force of the relay, N or N m; needed")
      ->type_name("N")
      ->group(simulation_group);
  command.add_option("--start", experiment.start_offset, "Where all bodies start, at rest, m or rad")
      ->type_name("M")
      ->capture_default_str()
      ->group(simulation_group);
  command.add_option("--duration", experiment.duration, "Of each trial, s")
      ->type_name("S")
      ->capture_default_str()
      ->group(simulation_group);
  command.add_option("--trials", experiment.trials, "Number of trials")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000))
      ->group(simulation_group);
  command
      .add_option("--variation", experiment.variation,
                  "Relative variation of start and friction between trials, either way")
      ->type_name("X")
      ->capture_default_str()
      ->group(simulation_group);
  command.add_option("--seed", experiment.seed, "Of the variation: the same seed, the same trials")
      ->type_name("N")
      ->capture_default_str()
      ->group(simulation_group);
  command.add_option("--csv", arguments.csv, "Also write force and position of all trials")
      ->type_name("FILE")
      ->group(simulation_group);
}

}  // namespace

void add_relay(CLI::App& app) {
  auto arguments = std::make_shared<RelayArguments>();
  CLI::App* command = app.add_subcommand(
      "relay", "The relay experiment, simulated or recorded: the stiffness it reads, beside what theory expects");
  add_device_arguments(*command, arguments->devices, FileCount::one_or_none);
  command->add_option("--recording", arguments->recording.file, "Analyse this recording instead of simulating")
      ->type_name("FILE");
  command->add_option("--hysteresis", arguments->experiment.relay.hysteresis, "Of the relay, m or rad")
      ->type_name("M")
      ->capture_default_str();
  command->add_option("--delay", arguments->delay, "Added to the device's own, s")
      ->type_name("S")
      ->capture_default_str();
  command->add_option("--segment", arguments->experiment.analysis.segment_length, "Samples of each spectrum")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(64, 1 << 24));
  command
      ->add_option("--steady", arguments->experiment.analysis.steady_tolerance,
                   "Largest relative difference in swing that counts as steady")
      ->type_name("X")
      ->capture_default_str();
  command->add_option("--motion", arguments->motion, "Of a recording without a device: linear or rotary, for the units")
      ->type_name("KIND")
      ->capture_default_str()
      ->check(CLI::IsMember({"linear", "rotary"}));
  command->add_flag("--json", arguments->json, "Print one JSON document on one line");
  command->add_option("--figure", arguments->figure, "Also draw force and position: .svg, .png or .pdf")
      ->type_name("FILE");
  add_simulation_options(*command, *arguments);
  add_recording_options(*command, arguments->recording);
  command->footer(
      "Examples:\n"
      "  zwidth relay devices/lhifam.toml --amplitude 5\n"
      "  zwidth relay devices/lhifam.toml --amplitude 5 --start 0.03 --set body.handle.coulomb=0.4\n"
      "  zwidth relay devices/lhifam.toml --amplitude 5 --delay 4e-3 --start 0.03 --csv run.csv\n"
      "  zwidth relay --recording run.csv --force force_1 --position position_1 --figure run.svg\n"
      "  zwidth relay devices/lhifam.toml --delay 4e-3 --recording run.csv --force 2 --position 3 --json");
  command->callback([arguments, command] {
    if (arguments->recording.list && !arguments->recording.file.empty()) {
      return write_standard_output(contents_text(arguments->recording));
    }
    check_options(*command, *arguments);
    run_relay(*arguments);
  });
}

}  // namespace zwidth::cli
