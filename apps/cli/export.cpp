#include "export/export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/outputs.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "export/export_c.hpp"
#include "export/export_chai3d.hpp"
#include "report/text/trust_text.hpp"
#include "results/export_json.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

constexpr double default_safety_factor = 0.5;

struct ExportArguments {
  DeviceArguments devices;
  std::string format;
  std::string output;
  std::string contact = "bilateral";
  std::optional<double> stiffness;
  std::optional<double> safety_factor;
};

void check(const ExportArguments& arguments, const CLI::App& command) {
  const auto only_for = [&](const std::string& option, const std::vector<std::string>& formats) {
    if (command.count(option) == 0) return;
    for (const std::string& format : formats) {
      if (arguments.format == format) return;
    }
    throw BadInput(fmt::format("{}: is for --format {}", option, fmt::join(formats, " and ")));
  };
  only_for("--contact", {"c"});
  only_for("--stiffness", {"c"});
  only_for("--safety-factor", {"c", "chai3d"});
  if (arguments.stiffness && arguments.safety_factor) {
    throw BadInput("--safety-factor: stands beside --stiffness; each sets the stiffness: give one of them");
  }
  if (arguments.stiffness && !(std::isfinite(*arguments.stiffness) && *arguments.stiffness > 0.0)) {
    throw BadInput(fmt::format("--stiffness: is {}; a number of N/m or N m/rad > 0", *arguments.stiffness));
  }
  if (arguments.safety_factor && !(*arguments.safety_factor > 0.0 && *arguments.safety_factor < 1.0)) {
    throw BadInput(fmt::format("--safety-factor: is {}; a number above 0 and below 1", *arguments.safety_factor));
  }
}

report::AnalysedDevice with_stiffness(const report::AnalysedDevice& analysed, double stiffness) {
  DeviceParameters parameters = analysed.device.parameters();
  parameters.wall.stiffness = stiffness;
  if (const auto problem = find_problem(parameters)) {
    throw BadInput(fmt::format("{} {}; {}", problem->key, problem->what, problem->allowed));
  }
  return report::analysed_device(Device(std::move(parameters)), {.draws = 0});
}

/// The stiffest wall of the file's damper and filters that no user destabilises; where there is none, K_CR.
report::CodedWall scaled_wall(const report::AnalysedDevice& analysed, double safety_factor) {
  const CriticalStiffness& critical = analysed.analysis.critical;
  if (critical.status != StiffnessStatus::finite) {
    throw BadInput(fmt::format("--safety-factor: {}; give --stiffness",
                               critical.status == StiffnessStatus::unbounded
                                   ? "every wall is stable, there is no limit to take a share of"
                                   : "no wall is stable, there is no limit to take a share of"));
  }
  const bool any_user = analysed.analysis.any_user && analysed.analysis.any_user->stiffness > 0.0 &&
                        std::isfinite(analysed.analysis.any_user->stiffness);
  const double limit = any_user ? analysed.analysis.any_user->stiffness : critical.stiffness;
  return {with_stiffness(analysed, safety_factor * limit),
          {},
          fmt::format("{} of the {}", safety_factor, any_user ? "limit for any user" : "critical stiffness")};
}

void check_it_is_not_refused(const ExportArguments& arguments, const Trust& trust) {
  if (trust.refused()) throw WorkFailed(arguments.devices.files.front() + ": " + report::verdict_text(trust));
}

report::CodedWall coded_wall(const ExportArguments& arguments) {
  report::AnalysedDevice analysed = std::move(analyze_devices(arguments.devices, AnalysisOptions{.draws = 0}).front());
  check_it_is_not_refused(arguments, analysed.analysis.trust);
  report::CodedWall wall = [&]() -> report::CodedWall {
    if (arguments.stiffness) return {with_stiffness(analysed, *arguments.stiffness), {}, "--stiffness"};
    if (arguments.safety_factor) return scaled_wall(analysed, *arguments.safety_factor);
    if (!analysed.device.parameters().wall.stiffness) {
      throw BadInput(arguments.devices.files.front() +
                     ": wall.stiffness: is missing: there is no wall to write; set it, or give --stiffness or "
                     "--safety-factor");
    }
    return {std::move(analysed), {}, "wall.stiffness"};
  }();
  check_it_is_not_refused(arguments, wall.analysed.analysis.trust);
  if (arguments.contact == "unilateral") wall.contact = ControllerOptions::Contact::unilateral;
  return wall;
}

std::string exported_c(const ExportArguments& arguments) {
  const report::CodedWall wall = coded_wall(arguments);
  if (!wall.analysed.analysis.wall->stable) {
    write_standard_error("zwidth: " + arguments.devices.files.front() +
                         ": the wall is UNSTABLE by linear analysis; the code says so too\n");
  }
  return report::export_c(wall);
}

std::string exported_chai3d(const ExportArguments& arguments) {
  const Device device = std::move(read_devices(arguments.devices).front());
  const double safety_factor = arguments.safety_factor.value_or(default_safety_factor);
  std::optional<WallCeilings> ceilings;
  try {
    ceilings = wall_ceilings(device, safety_factor);
  } catch (const Error& error) {
    throw WorkFailed(arguments.devices.files.front() + ": " + error.what());
  }
  if (!ceilings) {
    throw WorkFailed(arguments.devices.files.front() +
                     ": there is no ceiling to declare: without a damper no wall is stable, or every wall is");
  }
  return report::export_chai3d(device, *ceilings, safety_factor);
}

std::string exported(const ExportArguments& arguments) {
  if (arguments.format == "c") return exported_c(arguments);
  if (arguments.format == "chai3d") return exported_chai3d(arguments);
  const auto devices = analyze_devices(arguments.devices, limit_and_wall_only());
  const report::ExportedModel model = report::exported_model(devices.front());
  if (arguments.format == "octave") return export_octave(model);
  if (arguments.format == "python") return export_python(model);
  return results::line(results::export_json(model));
}

void run_export(const ExportArguments& arguments) {
  const bool to_file = !arguments.output.empty() && arguments.output != "-";
  Outputs outputs;
  if (to_file) outputs.add("--output", arguments.output);
  outputs.keep(arguments.devices.files, "device file");
  const std::string text = exported(arguments);
  outputs.put("--output", [&] { return text; });
  outputs.commit();
  if (!to_file) write_standard_output(text);
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand(
      "export", "The model for Octave, Python (SciPy) or as JSON; the wall as C code; ceilings for CHAI3D");
  add_device_arguments(*command, arguments->devices, FileCount::one);
  command
      ->add_option("--format", arguments->format,
                   "octave, python, json: the continuous and the exact discrete model\n"
                   "and the wall; c: the wall as one C99 file; chai3d: the ceilings\n"
                   "of a device's specification")
      ->type_name("FORMAT")
      ->required()
      ->check(CLI::IsMember({"octave", "python", "json", "c", "chai3d"}));
  command->add_option("-o,--output", arguments->output, "File to write; standard output unless given")
      ->type_name("FILE");
  command
      ->add_option("--contact", arguments->contact, "c: bilateral, a spring on both sides; unilateral: it only pushes")
      ->type_name("KIND")
      ->capture_default_str()
      ->check(CLI::IsMember({"bilateral", "unilateral"}));
  command->add_option("--stiffness", arguments->stiffness, "c: K, instead of wall.stiffness")->type_name("K");
  command
      ->add_option("--safety-factor", arguments->safety_factor,
                   "c: K is this share of the limit for any passive user, or of the\n"
                   "critical stiffness where there is no such limit;\n"
                   "chai3d: of both ceilings (default 0.5)")
      ->type_name("S");
  command->footer(
      "Examples:\n"
      "  zwidth export devices/lhifam.toml --format octave --output lhifam.m\n"
      "  zwidth export devices/lhifam.toml --format python --output lhifam.py\n"
      "  zwidth export devices/lhifam.toml --format json --set loop.delay=0.25e-3\n"
      "  zwidth export devices/lhifam.toml --format c --stiffness 3000 --contact unilateral -o wall.c\n"
      "  zwidth export devices/lhifam.toml --format c --safety-factor 0.5 --output wall.c\n"
      "  zwidth export devices/lhifam.toml --format chai3d --safety-factor 0.5");
  command->callback([arguments, command] {
    check(*arguments, *command);
    run_export(*arguments);
  });
}

}  // namespace zwidth::cli
