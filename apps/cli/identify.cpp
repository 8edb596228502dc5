#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
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
#include "zwidth/identification/measured_stiffness.hpp"
#include "zwidth/identification/record_fit.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::cli {
namespace {

struct IdentifyArguments {
  std::string method = "frequency-response";
  InverseDynamicsOptions inverse_dynamics;
  ResponseArguments response;
  StructureArguments structure;
  bool from_structure = false;
  bool no_hold = false;
  std::string output_device;
  std::string figure;
  bool json = false;
  bool points = false;
};

void check_method(const CLI::App& command, const IdentifyArguments& arguments) {
  if (arguments.method == "inverse-dynamics") return check_inverse_dynamics_options(command);
  refuse_inverse_dynamics_options(command);
  if (arguments.structure.structure.empty() && !arguments.response.recording.list) {
    throw BadInput("--structure: missing; a device file, or rigid, two-body or three-body");
  }
}

/// Declares the outputs in `outputs`. Throws BadInput for what cannot be written or read together.
void check(const IdentifyArguments& arguments, Outputs& outputs) {
  if (arguments.output_device != "-") outputs.add("--output-device", arguments.output_device);
  outputs.add("--figure", arguments.figure, Ending::figure);
  outputs.keep(arguments.response.recording.file, "recording");
  outputs.keep(arguments.structure.structure, "structure");
  if (arguments.output_device == "-" && arguments.json) {
    throw BadInput("--output-device: - is standard output, which --json takes; name a file");
  }
  if (arguments.response.recording.file == "-" && arguments.structure.structure == "-") {
    throw BadInput("standard input (-) is given for the recording and the structure; it can be read once");
  }
}

/// The fit, and the response it is of.
RecordFit fitted(const IdentifyArguments& arguments, const Device& device, const MeasuredResponse& measured) {
  ParameterFitOptions options;
  options.free = free_parameters(arguments.structure, device);
  options.locked = arguments.structure.locked;
  if (arguments.from_structure) options.start = ParameterFitOptions::Start::from_structure;
  if (arguments.no_hold) options.critical_point = ParameterFitOptions::CriticalPoint::free;
  try {
    RecordFit fit{fit_parameters(device, measured.response, options), measured.response};
    if (!measured.motion) return fit;
    return without_leakage(std::move(fit), measured.motion->force(), measured.motion->motion(), measured.options,
                           options);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::did_not_converge) throw WorkFailed(measured.source + ": " + error.what());
    throw BadInput(measured.source + ": " + error.what());
  }
}

bool is_locked(const IdentifyArguments& arguments, const std::string& body) {
  return std::ranges::find(arguments.structure.locked, body) != arguments.structure.locked.end();
}

/// Keys of the numbers that stand as they stood in the structure: those that the data leave open and, of a named
/// structure, those of its locked bodies.
std::vector<std::string> undetermined(const IdentifyArguments& arguments, const report::IdentifiedDevice& identified) {
  std::vector<std::string> keys;
  for (const ParameterEstimate& estimate : identified.fit.estimates) {
    if (!estimate.identifiable) keys.push_back(estimate.key);
  }
  if (!is_named_structure(arguments.structure)) return keys;
  for (const std::string& body : arguments.structure.locked) {
    for (const char* number : {"mass", "damping"}) keys.push_back(fmt::format("body.{}.{}", body, number));
  }
  return keys;
}

/// Numbers of a named structure that the data leave open are no one's.
void warn_of_placeholders(const IdentifyArguments& arguments, report::IdentifiedDevice& identified) {
  if (!is_named_structure(arguments.structure)) return;
  for (const std::string& key : undetermined(arguments, identified)) {
    identified.remarks.push_back({Remark::Severity::warning,
                                  fmt::format("{} = {:.4g} is a placeholder: the data do not determine it", key,
                                              parameter(identified.fit.device.parameters(), key).value_or(0.0)),
                                  "give what is known with --set, or a device file as the structure"});
  }
}

/// The device of the experiment: its bodies locked as in the recording, without a wall's damper and filters.
Device recorded_device(const IdentifyArguments& arguments, const Device& fitted) {
  DeviceParameters parameters = fitted.parameters();
  parameters.wall = {};
  parameters.uncertainty.reset();
  std::vector<std::size_t> locked;
  for (std::size_t i = 0; i < parameters.bodies.size(); ++i) {
    if (is_locked(arguments, parameters.bodies[i].name)) locked.push_back(i);
  }
  return locked.empty() ? Device(std::move(parameters)) : locked_device(Device(std::move(parameters)), locked);
}

/// A fit whose critical stiffness lies above the one that the same data show without a model is not to be trusted.
std::optional<Remark> unsafe_fit(const IdentifyArguments& arguments, const report::IdentifiedDevice& identified) {
  constexpr double tolerated = 1.05;
  const Device& device = identified.fit.device;
  const auto& period = identified.response.sampling_period;
  const bool same_loop = period && std::abs(*period - device.loop().sampling_period) <= 1e-6 * *period;
  if (!same_loop || identified.response.points.size() < 2) return std::nullopt;
  const MeasuredStiffness measured = measured_stiffness(identified.response);
  if (measured.crossovers.empty()) return std::nullopt;
  double proven = std::numeric_limits<double>::infinity();
  for (const MeasuredCrossover& each : measured.crossovers) {
    if (each.poles_leaving > 0) proven = std::min(proven, each.stiffness_interval.upper);
  }
  const double fitted =
      critical_stiffness(filtered_plant(sampled_plant(recorded_device(arguments, device)), {})).stiffness;
  if (!(fitted > tolerated * proven)) return std::nullopt;
  return Remark{
      Remark::Severity::warning,
      fmt::format("UNSAFE: the critical stiffness of the recorded device as fitted, {:.4g} {}, lies above {:.4g}, "
                  "where the same data show an oscillation without any model",
                  fitted, report::units_of(device.parameters().motion).stiffness, proven),
      "use the one of zwidth frf; the structure lacks something: try --free all,loop.delay,actuator.time_constant, or "
      "name bodies that were --locked"};
}

/// Into the fitted device's [uncertainty], so that what reads its file says it too: a K_CR above the measured one, and
/// parameters that the data do not determine, which count as exact.
void keep_distrust(const IdentifyArguments& arguments, const std::optional<Remark>& unsafe,
                   report::IdentifiedDevice& identified) {
  DeviceParameters parameters = identified.fit.device.parameters();
  if (!parameters.uncertainty) return;
  std::vector<std::string> distrust;
  if (unsafe) distrust.push_back(unsafe->what);
  const std::vector<std::string> keys = undetermined(arguments, identified);
  if (!keys.empty()) {
    distrust.push_back(
        fmt::format("the data do not determine {}: taken as they stand in the structure", fmt::join(keys, ", ")));
  }
  parameters.uncertainty->warning = fmt::format("{}", fmt::join(distrust, "; "));
  identified.fit.device = Device(std::move(parameters));
  identified.analysed.device = identified.fit.device;
}

report::IdentifiedDevice identified_device(const IdentifyArguments& arguments) {
  MeasuredResponse measured = measured_response(arguments.response);
  const Device device = structure(arguments.structure, measured.response.sampling_period);
  RecordFit fit = fitted(arguments, device, measured);
  report::AnalysedDevice analysed = [&] {
    try {
      return report::analysed_device(fit.fit.device);
    } catch (const Error& error) {
      throw WorkFailed(measured.source + ": " + error.what());
    }
  }();
  report::IdentifiedDevice identified{measured.source, std::move(fit.response), std::move(fit.fit), std::move(analysed),
                                      std::move(measured.remarks)};
  for (const Remark& remark : identified.fit.remarks) identified.remarks.push_back(remark);
  warn_of_placeholders(arguments, identified);
  const std::optional<Remark> unsafe = unsafe_fit(arguments, identified);
  if (unsafe) identified.remarks.push_back(*unsafe);
  keep_distrust(arguments, unsafe, identified);
  return identified;
}

/// The device file, its warnings as comments at the top: whoever reads it later is told as well.
std::string device_text(const report::IdentifiedDevice& identified) {
  std::string text;
  for (const Remark& remark : identified.remarks) {
    if (remark.severity != Remark::Severity::warning) continue;
    std::string line = "WARNING: " + report::remark_line(remark);
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    text += "# " + line + "\n";
  }
  return text + write_device(identified.fit.device.parameters());
}

std::string device_hint(const IdentifyArguments& arguments) {
  return arguments.output_device.empty() ? "\nThe device as a file: add --output-device FILE.toml\n"
                                         : "\nThe device is in " + arguments.output_device + "\n";
}

/// `identify --method inverse-dynamics`.
void run_inverse_dynamics(const IdentifyArguments& arguments, Outputs& outputs) {
  const report::IdentifiedRigidBody identified =
      fitted_rigid_body(arguments.response.recording, arguments.structure, arguments.inverse_dynamics);
  const std::string device = write_device(identified.device.parameters());
  outputs.put("--output-device", [&] { return device; });
  outputs.commit();
  if (arguments.json) {
    write_standard_output(results::line(rigid_body_json(identified)));
  } else if (arguments.output_device == "-") {
    write_warnings(identified.remarks);
    write_standard_output(device);
  } else {
    write_standard_output(rigid_body_text(identified) + device_hint(arguments));
  }
}

void run_identify(const IdentifyArguments& arguments) {
  if (arguments.response.recording.list) {
    write_standard_output(contents_text(arguments.response.recording));
    return;
  }
  Outputs outputs;
  check(arguments, outputs);
  if (arguments.method == "inverse-dynamics") return run_inverse_dynamics(arguments, outputs);
  const report::IdentifiedDevice identified = identified_device(arguments);
  const std::string device = device_text(identified);
  outputs.put("--output-device", [&] { return device; });
  outputs.draw("--figure", [&](report::FigureFormat format) { return draw_identification(identified, format); });
  outputs.commit();
  if (arguments.json) {
    const auto points = arguments.points ? report::PointsInJson::included : report::PointsInJson::left_out;
    write_standard_output(results::line(identification_json(identified, points)));
  } else if (arguments.output_device == "-") {
    write_warnings(identified.remarks);
    write_standard_output(device);
  } else {
    write_standard_output(identification_text(identified) + device_hint(arguments));
  }
}

}  // namespace

void add_identify(CLI::App& app) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = app.add_subcommand("identify", "Parameters of a device from a recording, with their uncertainty");
  add_response_arguments(*command, arguments->response);
  add_structure_arguments(*command, arguments->structure);
  command->get_option("--structure")->required(false);  // check_method() asks for it where it is needed
  add_inverse_dynamics_options(*command, arguments->inverse_dynamics);
  command->add_option("--method", arguments->method, "frequency-response, or inverse-dynamics (one rigid body)")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(CLI::IsMember({"frequency-response", "inverse-dynamics"}));
  command->add_flag("--from-structure", arguments->from_structure,
                    "Start from the structure's values instead of what the data suggest");
  command->add_flag("--no-hold", arguments->no_hold, "Do not hold an imperfect fit to the measured critical stiffness");
  command->add_option("--output-device", arguments->output_device, "Write the fitted device; - is standard output")
      ->type_name("FILE.toml");
  command->add_option("--figure", arguments->figure, "Draw data, band and fit (.svg, .png, .pdf)")->type_name("FILE");
  CLI::Option* json = command->add_flag("--json", arguments->json, "Print one JSON document on one line");
  command->add_flag("--points", arguments->points, "Measured and fitted response in the JSON document")->needs(json);
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
