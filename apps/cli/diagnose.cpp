#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/input_problem.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/recording_arguments.hpp"
#include "cli/refused_answer.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/device_bode_figure.hpp"
#include "report/text/diagnosis_text.hpp"
#include "results/diagnosis_json.hpp"
#include "zwidth/design/diagnosis.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::cli {
namespace {

struct DiagnoseArguments {
  DeviceArguments devices;
  std::optional<double> oscillates_hz;
  DiagnosisOptions options;
  RecordingArguments recording;
  OutputArguments output;
};

Recording read_position(RecordingArguments arguments) {
  arguments.position.name = position_column(arguments);
  if (arguments.position.name.empty())
    throw BadInput("--position", "missing", "name the column of the sensed position");
  RecordingOptions reading = recording_options(arguments);
  reading.columns = {arguments.position};
  constexpr std::pair<std::string_view, std::string_view> scale[] = {{"columns.0.scale", "--position-scale"}};
  if (const auto problem = find_problem(reading)) refuse(*problem, scale);
  ProgressLine line(*arguments.command, "reading " + arguments.file);
  auto recording = read_named_recording(*arguments.command, arguments.file, reading, line.progress());
  if (!recording) {
    const std::string& key = recording.error().place.key;
    const bool is_of_option = recording.error().place.line == 0 && key == arguments.position.name;
    refuse_input(recording.error(), is_of_option ? "--position" : "");
  }
  return *std::move(recording);
}

constexpr std::pair<std::string_view, std::string_view> options_of_diagnosis[] = {{"frequency", "--oscillates-hz"},
                                                                                  {"recording", "--recording"},
                                                                                  {"amplitude", "--amplitude"},
                                                                                  {"stiffness", "--stiffness"},
                                                                                  {"damping", "--damping"}};

Diagnosis diagnosed(const CLI::App& command, const Device& device, const std::optional<Recording>& recording,
                    DiagnosisOptions options, const std::string& file) {
  ProgressLine line(command, "diagnosing " + file);
  options.progress = line.progress();
  return worked(file, [&] { return recording ? diagnose(device, *recording, options) : diagnose(device, options); });
}

void run_diagnose(const CLI::App& command, DiagnoseArguments arguments) {
  const bool recorded = !arguments.recording.file.empty();
  if (recorded && arguments.recording.list) return write_contents(arguments.recording, arguments.output.json);
  if (recorded && arguments.oscillates_hz) {
    throw BadInput("--oscillates-hz", "excludes --recording, which shows the frequency", "give one of them");
  }
  if (!recorded && !arguments.oscillates_hz) {
    throw BadInput("--oscillates-hz", "missing", "give the frequency, or a recording that shows it with --recording");
  }
  for (const CLI::Option* option : command.parse_order()) {
    if (!recorded && option->get_group() == recording_group) {
      throw BadInput(option->get_name(), "is about a recording", "add --recording FILE");
    }
  }
  for (const char* option : {"--force", "--velocity", "--acceleration"}) {
    if (command.count(option) > 0) throw BadInput(option, "is not used here", "--position alone is");
  }
  const std::string& file = arguments.devices.files.front();
  const Device device = read_devices(arguments.devices).front();
  DiagnosisOptions& options = arguments.options;
  std::optional<Recording> recording;
  if (recorded) recording = read_position(arguments.recording);
  if (!recorded) options.frequency = radians_per_second(*arguments.oscillates_hz);
  const auto problem = recording ? find_problem(options, device, *recording) : find_problem(options, device);
  if (problem) refuse(*problem, options_of_diagnosis, file);
  Outputs outputs(command, arguments.output);
  outputs.keep(arguments.devices.files, "device file");
  if (!arguments.output.figure.empty()) {
    if (const auto no_figure = find_problem(BodeOptions{}, device)) refuse(*no_figure, {});
  }
  const Diagnosis diagnosis = diagnosed(command, device, recording, options, file);
  const std::string document = arguments.output.json ? results::line(results::diagnosis_json(device, diagnosis)) : "";
  if (diagnosis.trust.refused()) {
    return print_refused(outputs, diagnosis.trust, device.name(), document, {arguments.output.figure});
  }
  outputs.draw("--output", [&](report::FigureFormat format) {
    return report::draw(report::diagnosis_figure(device, diagnosis), format);
  });
  outputs.commit();
  if (arguments.output.json) return outputs.print(document);
  outputs.print_text(report::diagnosis_text(device, diagnosis));
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
  add_output_options(*command, arguments->output,
                     {.figure = "Also draw the loop's response with that frequency: .svg, .png or .pdf"});
  add_recording_options(*command, arguments->recording);
  command->footer(
      "Examples:\n"
      "  zwidth diagnose devices/lhifam.toml --oscillates-hz 6.3 --stiffness 9500\n"
      "  zwidth diagnose devices/lhifam.toml --oscillates-hz 41 --stiffness 6500 --amplitude 1e-3\n"
      "  zwidth diagnose devices/lhifam.toml --oscillates-hz 90 --json");
  command->callback([arguments, command] { run_diagnose(*command, *arguments); });
}

}  // namespace zwidth::cli
