#include "zwidth/simulation/relay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/input_problem.hpp"
#include "cli/option_refusal.hpp"
#include "cli/option_units.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/recording_arguments.hpp"
#include "cli/refused_answer.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/figures.hpp"
#include "report/text/relay_text.hpp"
#include "report/text/text_medium.hpp"
#include "results/relay_json.hpp"

namespace zwidth::cli {
namespace {

struct RelayArguments {
  DeviceArguments devices;
  RecordingArguments recording;
  RelayOptions experiment;  ///< what needs no translation is parsed straight into it
  double delay = 0.0;       ///< s, added to the device's
  std::string motion = "linear";
  OutputArguments output{.figure_option = "--figure"};
};

constexpr const char* simulation_group = "Simulation";

/// Options by the member of RelayOptions and of RelayRecordOptions that they set.
constexpr std::pair<std::string_view, std::string_view> options_of_relay[] = {
    {"relay.amplitude", "--amplitude"},
    {"relay.hysteresis", "--hysteresis"},
    {"hysteresis", "--hysteresis"},
    {"start_offset", "--start"},
    {"variation", "--variation"},
    {"trials", "--trials"},
    {"duration", "--duration"},
    {"analysis.segment_length", "--segment"},
    {"analysis.steady_tolerance", "--steady"},
};

/// The device with the delay added; nothing where no file is given.
std::optional<Device> delayed_device(const RelayArguments& arguments) {
  if (arguments.devices.files.empty()) return std::nullopt;
  auto device = with_added_delay(read_devices(arguments.devices).front(), arguments.delay);
  if (device) return *std::move(device);
  const DeviceProblem& problem = device.error();
  throw BadInput("--delay", fmt::format("{}{}{}", problem.key, problem.key.empty() ? "" : " ", problem.what),
                 problem.allowed);
}

RelayResult simulated(const RelayArguments& arguments, const Device& device) {
  if (const auto problem = find_problem(arguments.experiment, device)) refuse(*problem, options_of_relay);
  ProgressLine line(*arguments.devices.command, "simulating");
  return relay(device, arguments.experiment, line.progress());
}

RelayResult recorded(const RelayArguments& arguments, std::optional<Device> device) {
  RecordedMotion motion = read_motion(arguments.recording);
  if (motion.output != OutputQuantity::position) {
    throw BadInput(motion.output == OutputQuantity::velocity ? "--velocity" : "--acceleration",
                   "a relay acts on the position", "name its column with --position");
  }
  RelayRecordOptions options;
  options.device = std::move(device);
  options.motion = arguments.motion == "rotary" ? Motion::rotary : Motion::linear;
  if (!options.device) check_option_units(*arguments.devices.command, options.motion);
  options.hysteresis = arguments.experiment.relay.hysteresis;
  options.analysis = arguments.experiment.analysis;
  if (const auto problem = find_problem(options, motion.recording.sampling_period)) {
    constexpr std::string_view of_device = "device.";
    if (!problem->member.starts_with(of_device)) refuse(*problem, options_of_relay);
    const std::string key = problem->member.substr(of_device.size());
    refuse_key(arguments.devices.files.front(), key, problem->what, problem->allowed);
  }
  ProgressLine line(*arguments.devices.command, "predicting");
  return relay(std::move(motion.recording), options, line.progress());
}

void run_relay(const RelayArguments& arguments) {
  Outputs outputs(*arguments.devices.command, arguments.output);
  outputs.keep(arguments.devices.files, "device file");
  outputs.keep(arguments.recording.file, "recording");
  std::optional<Device> device = delayed_device(arguments);
  const RelayResult result =
      arguments.recording.file.empty() ? simulated(arguments, *device) : recorded(arguments, std::move(device));
  if (result.trials.empty()) {  // of a device that is refused
    return print_refused(outputs, result.trust, result.device->name(),
                         arguments.output.json ? results::line(results::relay_json(result))
                                               : report::for_medium(report::relay_text(result)),
                         {arguments.output.csv, arguments.output.figure});
  }
  outputs.put("--csv", [&] { return results::relay_csv(result); });
  outputs.draw("--figure", [&](report::FigureFormat format) { return report::draw_relay(result, format); });
  outputs.commit();
  for (std::size_t i = 0; i < result.trials.size(); ++i) {
    hand_over_series(*arguments.devices.command, fmt::format("force_{}", i + 1), result.trials[i].force);
    hand_over_series(*arguments.devices.command, fmt::format("position_{}", i + 1), result.trials[i].position);
  }
  outputs.print(arguments.output.json ? results::line(results::relay_json(result))
                                      : report::for_medium(report::relay_text(result)));
}

/// Options of what is not done would be ignored: refused instead.
void check_options(const CLI::App& command, const RelayArguments& arguments) {
  const bool is_recorded = !arguments.recording.file.empty();
  const bool has_device = !arguments.devices.files.empty();
  if (!is_recorded && !has_device) {
    throw BadInput("FILE", "missing", "a device file to simulate, or a recording with --recording");
  }
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string& name = option->get_name();
    if (!is_recorded && option->get_group() == recording_group) {
      throw BadInput(name, "is about a recording", "add --recording FILE");
    }
    if (is_recorded && option->get_group() == simulation_group) {
      throw BadInput(name, "is about a simulation", "leave out --recording");
    }
    const bool needs_device = name == "--delay" || name == "--hysteresis" || name == "--set";
    if (!has_device && needs_device) throw BadInput(name, "is about a device", "add its file");
    if (has_device && name == "--motion") throw BadInput("--motion", "the device file says it", "leave out the option");
  }
  if (!is_recorded && command.count("--amplitude") == 0) {
    throw BadInput("--amplitude", "missing", "the relay's force in N or N m");
  }
}

void add_simulation_options(CLI::App& command, RelayArguments& arguments) {
  RelayOptions& experiment = arguments.experiment;
  command.add_option("--amplitude", experiment.relay.amplitude, "Force of the relay, N or N m; needed")
      ->type_name("F")
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
  add_output_options(*command, arguments->output,
                     {.csv = "Also write force and position of all trials",
                      .figure = "Also draw force and position: .svg, .png or .pdf"});
  command->get_option("--csv")->group(simulation_group);
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
      return write_contents(arguments->recording, arguments->output.json);
    }
    check_options(*command, *arguments);
    run_relay(*arguments);
  });
}

}  // namespace zwidth::cli
