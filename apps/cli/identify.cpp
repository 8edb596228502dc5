#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/identify_in_time.hpp"
#include "cli/identify_rigid_body.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/remark_lines.hpp"
#include "cli/response_arguments.hpp"
#include "cli/standard_output.hpp"
#include "cli/structure_arguments.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/identification_figure.hpp"
#include "report/text/identification_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/remark_line.hpp"
#include "results/identification_json.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

struct IdentifyArguments {
  std::string method = "frequency-response";
  InverseDynamicsOptions inverse_dynamics;
  ResponseArguments response;
  StructureArguments structure;
  TimeDomainArguments in_time;
  bool from_structure = false;
  bool no_hold = false;
  std::string output_device;
  OutputArguments output{.figure_option = "--figure"};
  bool points = false;
};

void check_method(const CLI::App& command, const IdentifyArguments& arguments) {
  const bool is_in_time = arguments.method == "time-domain";
  if (!is_in_time) refuse_time_domain_options(command);
  if (arguments.method == "inverse-dynamics") return check_inverse_dynamics_options(command);
  refuse_inverse_dynamics_options(command);
  if (is_in_time) check_time_domain_options(command);
  if (arguments.structure.structure.empty() && !arguments.response.recording.list) {
    throw BadInput("--structure: missing; a device file, or rigid, two-body or three-body");
  }
}

/// Declares the outputs in `outputs`. Throws BadInput for what cannot be written or read together.
void check(const IdentifyArguments& arguments, Outputs& outputs) {
  if (arguments.output_device != "-") outputs.add("--output-device", arguments.output_device);
  outputs.add(arguments.output);
  outputs.keep(arguments.response.recording.file, "recording");
  for (const std::string& file : arguments.response.recording.more) outputs.keep(file, "recording");
  outputs.keep(arguments.structure.structure, "structure");
  if (arguments.output_device == "-" && arguments.output.json) {
    throw BadInput("--output-device: - is standard output, which --json takes; name a file");
  }
  if (arguments.response.recording.file == "-" && arguments.structure.structure == "-") {
    throw BadInput("standard input (-) is given for the recording and the structure; it can be read once");
  }
}

IdentifyOptions identify_options(const IdentifyArguments& arguments, const FrequencyResponseOptions& response) {
  IdentifyOptions options;
  options.response = response;
  options.fit.free = arguments.structure.free;
  options.fit.locked = arguments.structure.locked;
  if (arguments.from_structure) options.fit.start = ParameterFitOptions::Start::from_structure;
  if (arguments.no_hold) options.fit.critical_point = ParameterFitOptions::CriticalPoint::free;
  if (is_named_structure(arguments.structure)) {
    options.structure_values = IdentifyOptions::StructureValues::placeholders;
  }
  return options;
}

Identification identified_device(const IdentifyArguments& arguments) {
  const ResponseSource source = response_source(arguments.response);
  const Device device = structure(arguments.structure, source.sampling_period());
  const IdentifyOptions options = identify_options(arguments, source.options);
  try {
    ProgressLine line("identifying");
    return !source.recordings.empty() ? identify(source.recordings, device, options, line.progress())
                                      : identify(source.table, device, options);
  } catch (const Error& error) {
    const std::string name = source.recordings.size() > 1 ? "" : source.name + ": ";
    if (error.code() == ErrorCode::did_not_converge) throw WorkFailed(name + error.what());
    throw BadInput(name + error.what());
  }
}

/// The device file, its warnings as comments at the top: whoever reads it later is told as well.
std::string device_text(const Device& device, const std::vector<Remark>& remarks) {
  std::string text;
  for (const Remark& remark : remarks) {
    if (remark.severity != Remark::Severity::warning) continue;
    std::string line = "WARNING: " + report::remark_line(remark);
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    text += "# " + line + "\n";
  }
  return text + write_device(device.parameters());
}

std::string device_hint(const IdentifyArguments& arguments) {
  return arguments.output_device.empty() ? "\nThe device as a file: add --output-device FILE.toml\n"
                                         : "\nThe device is in " + arguments.output_device + "\n";
}

/// Writes the files that were asked for.
template <typename Identified>
void put(Outputs& outputs, const Identified& identified, const std::string& device) {
  outputs.put("--output-device", [&] { return device; });
  outputs.draw("--figure",
               [&](report::FigureFormat format) { return report::draw_identification(identified, format); });
  outputs.commit();
}

/// What a method found, as a document, as the device file alone, or in words.
template <typename Identified, typename Document>
void print(const IdentifyArguments& arguments, const Identified& identified, const std::string& device,
           const Document& document) {
  if (arguments.output.json) {
    write_standard_output(results::line(document()));
  } else if (arguments.output_device == "-") {
    write_warnings(identified.remarks);
    write_standard_output(device);
  } else {
    write_text(report::identification_text(identified) + device_hint(arguments));
  }
}

/// `identify --method inverse-dynamics`.
void run_inverse_dynamics(const IdentifyArguments& arguments, Outputs& outputs) {
  const RigidBodyIdentification identified =
      fitted_rigid_body(arguments.response.recording, arguments.structure, arguments.inverse_dynamics);
  const std::string device = write_device(identified.device.parameters());
  put(outputs, identified, device);
  print(arguments, identified, device, [&] { return results::identification_json(identified); });
}

/// `identify --method time-domain`.
void run_in_time(const IdentifyArguments& arguments, Outputs& outputs) {
  const TimeDomainIdentification identified =
      fitted_in_time(arguments.response.recording, arguments.structure, arguments.in_time);
  const std::string device = device_text(identified.device, identified.remarks);
  put(outputs, identified, device);
  print(arguments, identified, device, [&] { return results::identification_json(identified); });
}

void run_identify(const IdentifyArguments& arguments) {
  if (arguments.response.recording.list) {
    write_text(contents_text(arguments.response.recording));
    return;
  }
  Outputs outputs;
  check(arguments, outputs);
  if (arguments.method == "inverse-dynamics") return run_inverse_dynamics(arguments, outputs);
  if (arguments.method == "time-domain") return run_in_time(arguments, outputs);
  const Identification identified = identified_device(arguments);
  const std::string device = device_text(identified.fit.device, identified.remarks);
  put(outputs, identified, device);
  const auto points = arguments.points ? results::PointsInJson::included : results::PointsInJson::left_out;
  print(arguments, identified, device, [&] { return results::identification_json(identified, points); });
}

}  // namespace

void add_identify(CLI::App& app) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = app.add_subcommand("identify", "Parameters of a device from a recording, with their uncertainty");
  add_response_arguments(*command, arguments->response);
  add_structure_arguments(*command, arguments->structure);
  command->get_option("--structure")->required(false);  // check_method() asks for it where it is needed
  add_inverse_dynamics_options(*command, arguments->inverse_dynamics);
  add_time_domain_options(*command, arguments->in_time);
  command
      ->add_option("--method", arguments->method,
                   "frequency-response, time-domain (with dry friction), or\ninverse-dynamics (one rigid body)")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(CLI::IsMember({"frequency-response", "time-domain", "inverse-dynamics"}));
  command->add_flag("--from-structure", arguments->from_structure,
                    "Start from the structure's values instead of what the data suggest");
  command->add_flag("--no-hold", arguments->no_hold, "Do not hold an imperfect fit to the measured critical stiffness");
  command->add_option("--output-device", arguments->output_device, "Write the fitted device; - is standard output")
      ->type_name("FILE.toml");
  add_output_options(*command, arguments->output, {.figure = "Draw data, fit and residual (.svg, .png, .pdf)"});
  command->add_flag("--points", arguments->points, "Measured and fitted response in the JSON document")
      ->needs(command->get_option("--json"));
  command->footer(
      "Examples:\n"
      "  zwidth identify recordings/locked_chirp.csv --force force --position position \\\n"
      "    --structure devices/lhifam.toml --free link.stiffness,link.damping --locked handle\n"
      "  zwidth identify recordings/free_motion.csv --force force --position position \\\n"
      "    --method inverse-dynamics");
  command->callback([arguments, command] {
    check_method(*command, *arguments);
    run_identify(*arguments);
  });
}

}  // namespace zwidth::cli
