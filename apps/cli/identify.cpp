#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/limit_argument.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/request_context.hpp"
#include "cli/response_arguments.hpp"
#include "cli/structure_arguments.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/identification_figure.hpp"
#include "report/page/identification_page.hpp"
#include "report/text/identification_text.hpp"
#include "report/text/quantity.hpp"
#include "results/identification_json.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {
namespace {

struct IdentifyArguments {
  std::string method;  ///< empty: the library chooses
  InverseDynamicsOptions inverse_dynamics;
  ResponseArguments response;
  StructureArguments structure;
  double segment = IdentifyOptions{}.segment;
  std::vector<std::string> limits;
  bool from_structure = false;
  bool no_hold = false;
  std::string output_device;
  OutputArguments output{.figure_option = "--figure"};
  std::string report;
  bool points = false;

  [[nodiscard]] bool has_recording() const { return !response.recording.file.empty(); }
};

constexpr const char* motion_fit_group = "Fit of the motion";
constexpr const char* inverse_dynamics_group = "Inverse dynamics";

/// What a method does, for who gives it an option that it does not have; nothing where it has it.
std::optional<std::string_view> why_not(const CLI::Option& option, std::string_view method) {
  const std::string name = option.get_name();
  const std::string group = option.get_group();
  const bool of_response = group == "Table of a response" || name == "--velocity" || name == "--acceleration" ||
                           name == "--from-structure" || name == "--no-hold";
  if (method == "time-domain" && of_response) return "fits force and position";
  const bool of_device = group == "Estimate" || name == "--points" || name == "--limit" ||
                         (group == "Structure" && name != "--motion" && name != "--sampling-period");
  if (method == "inverse-dynamics" && (of_response || of_device)) return "fits one rigid body to its position";
  return std::nullopt;
}

/// Throws BadInput where there is nothing to fit to.
void check_recording(const CLI::App& command, const IdentifyArguments& arguments) {
  if (arguments.has_recording()) return;
  if (arguments.limits.empty()) {
    throw BadInput("FILE", "missing", "a recording to fit to, or a measured limit with --limit");
  }
  for (const CLI::Option* option : command.get_options()) {
    const std::string group = option->get_group();
    const bool of_recording = group == recording_group || group == "Estimate" || group == "Table of a response" ||
                              group == motion_fit_group || option->get_name() == "--method" ||
                              option->get_name() == "--points";
    if (option->count() > 0 && of_recording) {
      throw BadInput(option->get_name(), "is for a recording", "name the recording, or leave the option out");
    }
  }
  for (const char* option : {"--figure", "--csv"}) {
    if (command.count(option) == 0) continue;
    throw BadInput(option, "is of the response of a recording", "name the recording, or leave the option out");
  }
}

void check_method(const CLI::App& command, const IdentifyArguments& arguments) {
  const std::string& method = arguments.method;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    const std::string group = option->get_group();
    if (group == motion_fit_group && !method.empty() && method != "time-domain")
      throw BadInput(name, "is for --method time-domain");
    if (group == inverse_dynamics_group && method != "inverse-dynamics")
      throw BadInput(name, "is for --method inverse-dynamics");
    if (const auto why = why_not(*option, method)) {
      throw BadInput(name, CommandText("is not for --method ") + fmt::format("{}, which {}", method, *why),
                     "leave it out, or the method");
    }
  }
  if (method == "inverse-dynamics") {
    if (command.count("MORE") > 0) throw BadInput("", "more than one recording: is not for --method inverse-dynamics");
  } else if (arguments.structure.structure.empty() && !arguments.response.recording.list) {
    throw BadInput("--structure", "missing", "a device file, or rigid, two-body or three-body");
  }
}

/// Declares the outputs in `outputs`. Throws BadInput for what cannot be written or read together.
void check(const IdentifyArguments& arguments, Outputs& outputs) {
  if (arguments.output_device != "-") outputs.add("--output-device", arguments.output_device);
  outputs.add(arguments.output);
  outputs.add("--report", arguments.report, Ending::page);
  outputs.keep(arguments.response.recording.file, "recording");
  for (const std::string& file : arguments.response.recording.more) outputs.keep(file, "recording");
  outputs.keep(arguments.structure.structure, "structure");
  if (arguments.output_device == "-" && arguments.output.json) {
    throw BadInput("--output-device", "- is standard output, which --json takes", "name a file");
  }
  if (arguments.response.recording.file == "-" && arguments.structure.structure == "-") {
    throw BadInput("", "standard input (-) is given for the recording and the structure", "it can be read once");
  }
}

IdentifyOptions identify_options(const IdentifyArguments& arguments, const Structure& structure) {
  IdentifyOptions options;
  options.structure_values = structure.values;
  options.fit.free = arguments.structure.free;
  options.fit.locked = arguments.structure.locked;
  if (arguments.from_structure) options.fit.start = ParameterFitOptions::Start::from_structure;
  if (arguments.method == "time-domain") options.method = IdentifyOptions::Method::motion;
  if (arguments.method == "frequency-response") options.method = IdentifyOptions::Method::lines;
  options.segment = arguments.segment;
  const Motion motion = structure.device.parameters().motion;
  for (const std::string& each : arguments.limits) options.limits.push_back(measured_limit(each, motion));
  constexpr std::pair<std::string_view, std::string_view> own_options[] = {{"segment", "--segment-duration"}};
  if (const auto problem = find_problem(options)) refuse(*problem, own_options);
  return options;
}

/// The library's work, with progress.
template <typename Work>
auto fitted(const CLI::App& command, const std::string& name, const Work& work, OptionsByMember options) {
  const auto with_progress = [&] {
    ProgressLine line(command, "identifying");
    return work(line.progress());
  };
  return worked(name, with_progress, options);
}

Identification identified_device(const IdentifyArguments& arguments) {
  if (!arguments.has_recording()) {
    const Structure fitted_structure = structure(arguments.structure, {}, {});
    worked(arguments.structure.structure, [&] { require_one_rate(fitted_structure.device); });
    const IdentifyOptions options = identify_options(arguments, fitted_structure);
    return fitted(*arguments.response.command, "",
                  [&](const Progress&) { return identify_from_limits(fitted_structure.device, options); }, {});
  }
  const ResponseSource source = response_source(arguments.response);
  const Structure fitted_structure = structure(arguments.structure, source.sampling_period(), source.recordings);
  worked(arguments.structure.structure, [&] { require_open_damper(fitted_structure.device); });
  IdentifyOptions options = identify_options(arguments, fitted_structure);
  options.response = source.options;
  const auto identified = [&](const Progress& progress) {
    return !source.recordings.empty() ? identify(source.recordings, fitted_structure.device, options, progress)
                                      : identify(source.table, fitted_structure.device, options);
  };
  return fitted(*arguments.response.command, source.recordings.size() > 1 ? "" : source.name, identified,
                options_of_response());
}

RigidBodyIdentification fitted_rigid_body(const IdentifyArguments& arguments) {
  const RigidBodyOptions options{arguments.inverse_dynamics, asked_motion(arguments.structure),
                                 arguments.structure.sampling_period};
  constexpr std::pair<std::string_view, std::string_view> own_options[] = {
      {"sampling_period", "--sampling-period"},
      {"inverse_dynamics.cutoff_hz", "--cutoff-hz"},
      {"cutoff_hz", "--cutoff-hz"},
      {"inverse_dynamics.decimation", "--decimation"},
      {"decimation", "--decimation"}};
  if (const auto problem = find_problem(options)) refuse(*problem, own_options);
  const RecordedMotion motion = read_motion(arguments.response.recording);
  const auto identified = [&](const Progress& progress) {
    return identify_rigid_body(motion.recording, options, progress);
  };
  return fitted(*arguments.response.command, arguments.response.recording.file, identified, own_options);
}

std::string device_hint(const IdentifyArguments& arguments) {
  return arguments.output_device.empty() ? "\nThe device as a file: add --output-device FILE.toml\n"
                                         : "\nThe device is in " + arguments.output_device + "\n";
}

/// Writes the files that were asked for.
template <typename Identified>
void put(const IdentifyArguments& arguments, Outputs& outputs, const Identified& identified,
         const std::string& device) {
  outputs.put("--output-device", [&] { return device; });
  hand_over_device(*arguments.response.command, device);
  outputs.put("--csv", [&] { return results::identification_csv(identified); });
  outputs.draw("--figure",
               [&](report::FigureFormat format) { return report::draw_identification(identified, format); });
  outputs.put("--report", [&] { return report::identification_page(identified); });
  outputs.commit();
}

/// What a method found, as a document, as the device file alone, or in words.
template <typename Identified, typename Document>
void print(const IdentifyArguments& arguments, const Outputs& outputs, const Identified& identified,
           const std::string& device, const Document& document) {
  if (arguments.output.json) {
    outputs.print(results::line(document()));
  } else if (arguments.output_device == "-") {
    outputs.warn(identified.remarks);
    outputs.print(device);
  } else {
    outputs.print_text(report::identification_text(identified, arguments.output.findings) + device_hint(arguments));
  }
}

/// `identify --method inverse-dynamics`.
void run_inverse_dynamics(const IdentifyArguments& arguments, Outputs& outputs) {
  const RigidBodyIdentification identified = fitted_rigid_body(arguments);
  const std::string device = write_device(identified.device.parameters(), identified.remarks);
  put(arguments, outputs, identified, device);
  print(arguments, outputs, identified, device, [&] { return results::identification_json(identified); });
}

void run_identify(const IdentifyArguments& arguments) {
  if (arguments.response.recording.list) {
    return write_contents(arguments.response.recording, arguments.output.json);
  }
  Outputs outputs(*arguments.response.command);
  check(arguments, outputs);
  if (arguments.method == "inverse-dynamics") return run_inverse_dynamics(arguments, outputs);
  const Identification identified = identified_device(arguments);
  const std::string device = write_device(identified.fit.device.parameters(), identified.remarks);
  put(arguments, outputs, identified, device);
  const auto points = arguments.points ? results::PointsInJson::included : results::PointsInJson::left_out;
  print(arguments, outputs, identified, device, [&] { return results::identification_json(identified, points); });
}

}  // namespace

void add_identify(CLI::App& app) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = app.add_subcommand("identify", "Parameters of a device from a recording, with their uncertainty");
  add_response_arguments(*command, arguments->response);
  add_structure_arguments(*command, arguments->structure);
  // check_method() and check_recording() ask for them where they are needed.
  command->get_option("--structure")->required(false);
  command->get_option("FILE")->required(false);
  command
      ->add_option("--cutoff-hz", arguments->inverse_dynamics.cutoff_hz, "Of the low-pass; else chosen from the motion")
      ->type_name("HZ")
      ->group(inverse_dynamics_group);
  command
      ->add_option("--decimation", arguments->inverse_dynamics.decimation,
                   "Every N-th sample is kept; else chosen from the cutoff")
      ->type_name("N")
      ->group(inverse_dynamics_group);
  command->add_option("--segment-duration", arguments->segment, "Each segment begins in a state of its own")
      ->type_name("S")
      ->capture_default_str()
      ->group(motion_fit_group);
  command
      ->add_option("--method", arguments->method,
                   "time-domain (the motion itself; the default of a recording),\n"
                   "frequency-response (its lines; the default of a table), or\ninverse-dynamics (one rigid body)")
      ->type_name("NAME")
      ->check(CLI::IsMember({"time-domain", "frequency-response", "inverse-dynamics"}));
  command
      ->add_option("--limit", arguments->limits,
                   "A wall at which the device was seen to oscillate:\n\"K=3, B=0, hz=40\"; may be repeated; with or "
                   "without a recording")
      ->type_name("LIMIT")
      ->allow_extra_args(false);
  command->add_flag("--from-structure", arguments->from_structure,
                    "Start from the structure's values instead of what the data suggest");
  command->add_flag("--no-hold", arguments->no_hold,
                    "Without effect: no fit is held to the measured critical stiffness");
  command->add_option("--output-device", arguments->output_device, "Write the fitted device; - is standard output")
      ->type_name("FILE.toml");
  add_output_options(*command, arguments->output,
                     {.csv = "Also write what was measured and fitted",
                      .figure = "Draw data, fit and residual (.svg, .png, .pdf)",
                      .explain = explain_help});
  command->add_option("--report", arguments->report, "Also write one self-contained page with limits and figure")
      ->type_name("OUT.html");
  command->add_flag("--points", arguments->points, "Measured and fitted response in the JSON document")
      ->needs(command->get_option("--json"));
  command->footer(
      "Examples:\n"
      "  zwidth identify recordings/locked_chirp.csv --force force --position position \\\n"
      "    --structure devices/lhifam.toml --free link.stiffness,link.damping --locked handle\n"
      "  zwidth identify recordings/free_motion.csv --force force --position position \\\n"
      "    --method inverse-dynamics\n"
      "  zwidth identify --structure devices/lhifam.toml --free body.handle.damping --limit \"K=8000, hz=6\"");
  command->callback([arguments, command] {
    check_recording(*command, *arguments);
    check_method(*command, *arguments);
    run_identify(*arguments);
  });
}

}  // namespace zwidth::cli
