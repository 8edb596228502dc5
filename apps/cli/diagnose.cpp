#include <fmt/format.h>

#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/input_problem.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/recording_arguments.hpp"
#include "cli/remark_lines.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "cli/surroundings.hpp"
#include "report/text/diagnosis_text.hpp"
#include "report/text/trust_text.hpp"
#include "results/diagnosis_json.hpp"
#include "zwidth/design/diagnosis.hpp"
#include "zwidth/error.hpp"
#include "zwidth/signal/dominant_oscillation.hpp"

namespace zwidth::cli {
namespace {

struct DiagnoseArguments {
  DeviceArguments devices;
  std::optional<double> oscillates_hz;
  DiagnosisOptions options;
  RecordingArguments recording;
  OutputArguments output;
};

/// Frequency and amplitude as the recording shows them.
void take_from_recording(const RecordingArguments& arguments, DiagnosisOptions& options) {
  if (arguments.position.name.empty()) throw BadInput("--position: missing; name the column of the sensed position");
  RecordingOptions reading = recording_options(arguments);
  reading.columns = {arguments.position};
  ProgressLine line("reading " + arguments.file);
  const auto recording = read_named_recording(arguments.file, reading, line.progress());
  if (!recording) throw BadInput(input_problem(recording.error()));
  write_warnings(recording->remarks);
  const auto found = dominant_oscillation(recording->channels.front().samples, recording->sampling_period);
  if (!found) throw WorkFailed(arguments.file + ": nothing oscillates in its last half");
  options.frequency = found->frequency;
  if (!options.amplitude) options.amplitude = found->amplitude;
}

const char* diagnose_option_of(const std::string& member) {
  if (member == "frequency") return "--oscillates-hz";
  if (member == "amplitude") return "--amplitude";
  return member == "stiffness" ? "--stiffness" : "--damping";
}

void run_diagnose(const CLI::App& command, DiagnoseArguments arguments) {
  const bool recorded = !arguments.recording.file.empty();
  if (recorded && arguments.recording.list) return write_text(contents_text(arguments.recording));
  if (recorded == arguments.oscillates_hz.has_value()) {
    throw BadInput("--oscillates-hz: give the frequency, or a recording that shows it with --recording");
  }
  for (const CLI::Option* option : command.parse_order()) {
    if (!recorded && option->get_group() == recording_group) {
      throw BadInput(fmt::format("{}: is about a recording; add --recording FILE", option->get_name()));
    }
  }
  for (const char* option : {"--force", "--velocity", "--acceleration"}) {
    if (command.count(option) > 0) throw BadInput(fmt::format("{}: is not used; give --position", option));
  }
  const std::string& file = arguments.devices.files.front();
  const Device device = read_devices(arguments.devices).front();
  DiagnosisOptions& options = arguments.options;
  if (recorded) {
    take_from_recording(arguments.recording, options);
  } else {
    options.frequency = 2.0 * std::numbers::pi * *arguments.oscillates_hz;
  }
  if (const auto problem = find_problem(options, device)) {
    throw BadInput(
        fmt::format("{}: {}: {}; {}",
                    recorded && problem->member == "frequency" ? "--recording" : diagnose_option_of(problem->member),
                    file, problem->what, problem->allowed));
  }
  std::optional<Diagnosis> diagnosis;
  try {
    diagnosis = diagnose(device, options);
  } catch (const Error& error) {
    throw WorkFailed(file + ": " + error.what());
  }
  if (arguments.output.json) write_standard_output(results::line(results::diagnosis_json(device, options, *diagnosis)));
  if (diagnosis->trust.refused()) throw WorkFailed(file + ": " + report::verdict_text(diagnosis->trust));
  if (!arguments.output.json) write_text(report::diagnosis_text(device, options, *diagnosis));
}

}  // namespace

void add_diagnose(CLI::App& app) {
  auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* command = app.add_subcommand("diagnose", "What an oscillation at a given frequency is, and what moves it");
  add_device_arguments(*command, arguments->devices, FileCount::one);
  command->add_option("--oscillates-hz", arguments->oscillates_hz, "The frequency at which it oscillates")
      ->type_name("HZ");
  command->add_option("--stiffness", arguments->options.stiffness, "K of the wall; else the file's")->type_name("K");
  command->add_option("--damping", arguments->options.damping, "B of the wall; else the file's")->type_name("B");
  command
      ->add_option("--amplitude", arguments->options.amplitude,
                   "Of the sensed position, m or rad: tells small causes from great")
      ->type_name("M");
  command->add_option("--recording", arguments->recording.file, "Take frequency and amplitude from its last half")
      ->type_name("FILE");
  add_output_options(*command, arguments->output, {});
  add_recording_options(*command, arguments->recording);
  command->footer(
      "Examples:\n"
      "  zwidth diagnose devices/lhifam.toml --oscillates-hz 6.3 --stiffness 9500\n"
      "  zwidth diagnose devices/lhifam.toml --oscillates-hz 41 --stiffness 6500 --amplitude 1e-3\n"
      "  zwidth diagnose devices/lhifam.toml --oscillates-hz 90 --json");
  command->callback([arguments, command] { run_diagnose(*command, *arguments); });
}

}  // namespace zwidth::cli
