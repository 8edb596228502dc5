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
#include "results/json.hpp"
#include "zwidth/design/safe_wall.hpp"
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
  bool accept_doubt = false;
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
  only_for("--accept-doubt", {"c"});
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

report::AnalysedDevice with_stiffness(const Device& device, double stiffness) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = stiffness;
  if (const auto problem = find_problem(parameters)) {
    throw BadInput(fmt::format("{} {}; {}", problem->key, problem->what, problem->allowed));
  }
  return report::analysed_device(Device(std::move(parameters)), {.draws = 0});
}

/// Nothing is written on a refused device, a wall to run on a doubtful one only where that is asked for.
void check_trust(const ExportArguments& arguments, const Trust& trust) {
  if (trust.refused()) throw WorkFailed(arguments.devices.files.front() + ": " + report::verdict_text(trust));
  if (!trust.sound() && !arguments.accept_doubt) {
    throw WorkFailed(arguments.devices.files.front() + ": " + report::verdict_text(trust) +
                     "; --accept-doubt writes the wall all the same");
  }
}

/// A wall that can be taken a share of.
SafeWall chosen_wall(const ExportArguments& arguments, const Device& device, const SafeWallOptions& options) {
  SafeWall wall = [&] {
    try {
      return safe_wall(device, options);
    } catch (const Error& error) {
      throw WorkFailed(arguments.devices.files.front() + ": " + error.what());
    }
  }();
  const auto refuse = [&](const std::string& why) {
    const std::string subject = arguments.format == "c" ? "--safety-factor" : "there is no ceiling to declare";
    const std::string message = arguments.devices.files.front() + ": " + subject + ": " + why;
    if (arguments.format == "c") throw BadInput(message + "; give --stiffness");
    throw WorkFailed(message);
  };
  switch (wall.status) {
    case SafeWall::Status::refused:
      throw WorkFailed(arguments.devices.files.front() + ": " + report::verdict_text(wall.trust));
    case SafeWall::Status::none_stable:
      refuse("no wall is stable, there is no limit to take a share of");
      break;
    case SafeWall::Status::unbounded:
      refuse("every wall is stable, there is no limit to take a share of");
      break;
    case SafeWall::Status::chosen:
      break;
  }
  return wall;
}

/// Says how K was chosen.
std::string source_of(const SafeWall& wall, double safety_factor) {
  const char* limit = wall.basis == SafeWall::Basis::any_user ? "limit for any user" : "critical stiffness";
  if (wall.uncertainty_share == 1.0) return fmt::format("{} of the {}", safety_factor, limit);
  return fmt::format("{} of the {} at the lower end of its 95 % interval", safety_factor, limit);
}

report::CodedWall coded_wall(const ExportArguments& arguments) {
  Device device = std::move(read_devices(arguments.devices).front());
  report::CodedWall wall = [&]() -> report::CodedWall {
    if (arguments.stiffness) return {with_stiffness(device, *arguments.stiffness), {}, "--stiffness"};
    if (arguments.safety_factor) {
      SafeWall chosen = chosen_wall(arguments, device, {.safety_factor = *arguments.safety_factor});
      report::CodedWall scaled{
          with_stiffness(device, chosen.stiffness), {}, source_of(chosen, *arguments.safety_factor)};
      scaled.analysed.analysis.trust.inherit(chosen.trust);
      return scaled;
    }
    if (!device.parameters().wall.stiffness) {
      throw BadInput(arguments.devices.files.front() +
                     ": wall.stiffness: is missing: there is no wall to write; set it, or give --stiffness or "
                     "--safety-factor");
    }
    return {report::analysed_device(std::move(device), {.draws = 0}), {}, "wall.stiffness"};
  }();
  check_trust(arguments, wall.analysed.analysis.trust);
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
  const SafeWall wall =
      chosen_wall(arguments, device, {.safety_factor = safety_factor, .damping = SafeWallOptions::Damping::ceiling});
  return report::export_chai3d(device, wall, safety_factor);
}

std::string exported(const ExportArguments& arguments) {
  if (arguments.format == "c") return exported_c(arguments);
  if (arguments.format == "chai3d") return exported_chai3d(arguments);
  const DeviceModel model = device_model(read_devices(arguments.devices).front());
  if (arguments.format == "octave") return report::export_octave(model);
  if (arguments.format == "python") return report::export_python(model);
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
                   "critical stiffness where there is no such limit; of the lower end\n"
                   "of the 95 % interval where the device has one;\n"
                   "chai3d: of both ceilings (default 0.5)")
      ->type_name("FACTOR");
  command->add_flag("--accept-doubt", arguments->accept_doubt,
                    "c: write the wall of a device that is doubtful (its file says why)");
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
