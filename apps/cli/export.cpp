#include "export/export.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/input_problem.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/subcommand.hpp"
#include "export/export_c.hpp"
#include "export/export_chai3d.hpp"
#include "export/export_drive.hpp"
#include "report/text/trust_text.hpp"
#include "results/export_json.hpp"
#include "results/json.hpp"
#include "zwidth/design/wall_to_run.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::cli {
namespace {

constexpr double lowest_rate = 1.0;  // Hz, of a drive's loop
constexpr double highest_rate = 1e7;

const std::map<std::string, DriveFirmware> drive_firmware{{"odrive", DriveFirmware::odrive},
                                                          {"moteus", DriveFirmware::moteus},
                                                          {"simplefoc", DriveFirmware::simplefoc},
                                                          {"openffboard", DriveFirmware::openffboard},
                                                          {"vesc", DriveFirmware::vesc}};

struct ExportArguments {
  DeviceArguments devices;
  std::string format;
  std::optional<DriveFirmware> units;
  DriveLoopOptions drive_loop;
  std::optional<double> drive_rate;  // Hz
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
    throw BadInput(option, CommandText("is for --format ") + fmt::format("{}", fmt::join(formats, " and ")));
  };
  if (arguments.format.empty() != arguments.units.has_value()) {
    if (arguments.units) throw BadInput("--units", "is given beside --format", "give one of them");
    throw BadInput("--format", "is missing", "must be a value, or give --units");
  }
  only_for("--contact", {"c"});
  for (const char* option : {"--drive-rate", "--drive-delay", "--estimator-bandwidth"}) {
    if (!arguments.units && command.count(option) > 0) throw BadInput(option, "is for --units");
  }
  if (arguments.units) {
    if (command.count("--safety-factor") == 0) return;
    throw BadInput("--safety-factor", "the limit on the drive is not known well enough to take a share of",
                   "give --stiffness");
  }
  only_for("--stiffness", {"c"});
  only_for("--safety-factor", {"c", "chai3d"});
  only_for("--accept-doubt", {"c"});
}

/// The library's members as the options that set them.
constexpr std::pair<std::string_view, std::string_view> options_of_wall[] = {{"stiffness", "--stiffness"},
                                                                             {"safety_factor", "--safety-factor"}};

constexpr std::pair<std::string_view, std::string_view> options_of_drive[] = {
    {"sampling_period", "--drive-rate"}, {"delay", "--drive-delay"}, {"estimator_bandwidth", "--estimator-bandwidth"}};

/// A limit to take a share of, or the reason why there is none.
void check_share(const ExportArguments& arguments, const SafeWall& wall) {
  const std::string& file = arguments.devices.files.front();
  if (wall.status == SafeWall::Status::chosen) return;
  if (wall.status == SafeWall::Status::refused) throw WorkFailed(file, report::verdict_text(wall.trust));
  const std::string why = fmt::format(
      "{}: there is no limit to take a share of",
      wall.status == SafeWall::Status::unbounded ? "every wall is stable" : "no wall is stable from K = 0 on");
  if (arguments.format == "chai3d") throw WorkFailed(file, "there is no ceiling to declare: " + why);
  throw BadInput("--safety-factor", why, "give --stiffness");
}

/// Says how K was chosen.
std::string source_of(const ExportArguments& arguments, const WallToRun& wall) {
  if (!wall.share) return arguments.stiffness ? "--stiffness" : "wall.stiffness";
  const char* limit = wall.share->basis == SafeWall::Basis::any_user ? "limit for any user" : "critical stiffness";
  std::string text = fmt::format("{} of the {}", *arguments.safety_factor, limit);
  if (wall.share->uncertainty_share == 1.0) return text;
  return text +
         fmt::format(", at {:.4g} of it: the lower end of the limits' 95 % intervals", wall.share->uncertainty_share);
}

WallToRun released_wall(const ExportArguments& arguments) {
  const std::string& file = arguments.devices.files.front();
  const Device device = std::move(read_devices(arguments.devices).front());
  const WallToRunOptions options{arguments.stiffness, arguments.safety_factor, arguments.accept_doubt};
  if (const auto problem = find_problem(options, device)) {
    if (!option_of(options_of_wall, problem->member).empty()) refuse(*problem, options_of_wall);
    refuse_key(file, problem->member, problem->what,
               OptionText(problem->allowed) + CommandText(", or give --stiffness or --safety-factor"));
  }
  WallToRun wall = worked(arguments.devices.files.front(), [&] { return wall_to_run(device, options); });
  if (wall.share) check_share(arguments, *wall.share);
  if (!wall.released) {
    const Trust& trust = wall.analysis.trust;
    throw WorkFailed(file, CommandText(report::verdict_text(trust)) +
                               CommandText(trust.refused() ? "" : "; --accept-doubt writes the wall all the same"));
  }
  return wall;
}

report::CodedWall coded_wall(const ExportArguments& arguments) {
  WallToRun wall = released_wall(arguments);
  const bool unilateral = arguments.contact == "unilateral";
  std::string source = source_of(arguments, wall);
  return {std::move(wall), unilateral ? ControllerOptions::Contact::unilateral : ControllerOptions::Contact::bilateral,
          std::move(source)};
}

std::string exported_c(const ExportArguments& arguments, const Outputs& outputs) {
  const report::CodedWall wall = coded_wall(arguments);
  if (const std::string holders = unstable_with(*wall.wall.analysis.wall_stable_for); !holders.empty()) {
    outputs.tell(fmt::format("zwidth: {}: the wall is UNSTABLE by linear analysis, {}; the code says so too\n",
                             arguments.devices.files.front(), holders));
  }
  return report::export_c(wall);
}

/// The device with --stiffness, of which the drive closes the damper alone.
std::optional<Device> device_with_damper_on_drive(const ExportArguments& arguments) {
  DeviceParameters parameters = read_devices(arguments.devices).front().parameters();
  if (!has_damper_loop(parameters.loop)) return std::nullopt;
  if (arguments.stiffness) parameters.wall.stiffness = arguments.stiffness;
  if (const auto problem = find_problem(parameters)) throw BadInput("--stiffness", problem->what, problem->allowed);
  Device device(std::move(parameters));
  const Trust trust = trust_of(device);
  if (trust.sound() || (!trust.refused() && arguments.accept_doubt)) return device;
  throw WorkFailed(arguments.devices.files.front(),
                   CommandText(report::verdict_text(trust)) +
                       CommandText(trust.refused() ? "" : "; --accept-doubt writes the damper all the same"));
}

std::string exported_for_drive(const ExportArguments& arguments, const Outputs& outputs) {
  const std::string& file = arguments.devices.files.front();
  const auto damped = device_with_damper_on_drive(arguments);
  const WallToRun wall = damped ? WallToRun{.device = *damped} : released_wall(arguments);
  if (const auto problem = find_problem(*arguments.units, wall.device)) {
    refuse_key(file, problem->member, problem->what, problem->allowed);
  }
  DriveLoopOptions loop = arguments.drive_loop;
  if (const auto rate = arguments.drive_rate) {
    if (!(*rate >= lowest_rate && *rate <= highest_rate)) {
      throw BadInput("--drive-rate", fmt::format("is {} Hz", *rate),
                     fmt::format("must be {} to {:g}", lowest_rate, highest_rate));
    }
    loop.sampling_period = 1.0 / *rate;
  }
  if (const auto problem = find_problem(loop, *arguments.units, wall.device)) {
    if (!option_of(options_of_drive, problem->member).empty()) refuse(*problem, options_of_drive);
    refuse_key(file, problem->member, problem->what, problem->allowed);
  }
  const DriveGains gains = worked(file, [&] { return drive_gains(wall.device, *arguments.units, loop); });
  const Trust& trust = gains.on_drive.trust;
  if (trust.refused()) throw WorkFailed(file, "closed on the drive: " + report::verdict_text(trust));
  const auto& stable_for = gains.on_drive.wall_stable_for;
  if (const std::string holders = stable_for ? unstable_with(*stable_for) : ""; !holders.empty()) {
    outputs.tell(
        fmt::format("zwidth: {}: closed on the drive, the wall is UNSTABLE by linear analysis, {}\n", file, holders));
  }
  return report::export_drive(wall.device, gains, source_of(arguments, wall));
}

std::string exported_chai3d(const ExportArguments& arguments) {
  const Device device = std::move(read_devices(arguments.devices).front());
  SafeWallOptions options{.damping = SafeWallOptions::Damping::ceiling};
  options.safety_factor = arguments.safety_factor.value_or(options.safety_factor);
  if (const auto problem = find_problem(options)) refuse(*problem, options_of_wall);
  require_one_rate(device);  // CHAI3D runs the damper with the spring
  const SafeWall wall = worked(arguments.devices.files.front(), [&] { return safe_wall(device, options); });
  check_share(arguments, wall);
  return report::export_chai3d(device, wall, options.safety_factor);
}

std::string exported(const ExportArguments& arguments, const Outputs& outputs) {
  if (arguments.units) return exported_for_drive(arguments, outputs);
  if (arguments.format == "c") return exported_c(arguments, outputs);
  if (arguments.format == "chai3d") return exported_chai3d(arguments);
  const Device device = std::move(read_devices(arguments.devices).front());
  const DeviceModel model = worked(arguments.devices.files.front(), [&] { return device_model(device); });
  if (arguments.format == "octave") return report::export_octave(model);
  if (arguments.format == "python") return report::export_python(model);
  return results::line(results::export_json(model));
}

void run_export(const ExportArguments& arguments) {
  const bool to_file = !arguments.output.empty() && arguments.output != "-";
  Outputs outputs(*arguments.devices.command);
  if (to_file) outputs.add("--output", arguments.output);
  outputs.keep(arguments.devices.files, "device file");
  const std::string text = exported(arguments, outputs);
  outputs.put("--output", [&] { return text; });
  outputs.commit();
  if (!to_file) outputs.print(text);
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
      ->check(CLI::IsMember({"octave", "python", "json", "c", "chai3d"}));
  command
      ->add_option_function<std::string>(
          "--units", [arguments](const std::string& name) { arguments->units = drive_firmware.at(name); },
          "odrive, moteus, simplefoc, openffboard, vesc: the wall in the\n"
          "numbers that the drive's firmware takes, and what becomes of it\n"
          "where the loop closes on the drive; [driver] says what it turns")
      ->type_name("FIRMWARE")
      ->check(CLI::IsMember(std::vector<std::string>{"odrive", "moteus", "simplefoc", "openffboard", "vesc"}));
  command
      ->add_option("--drive-rate", arguments->drive_rate,
                   "--units: rate of the drive's own loop, instead of its default\n"
                   "(simplefoc: of the sketch, measured)")
      ->type_name("HZ");
  command
      ->add_option("--drive-delay", arguments->drive_loop.delay,
                   "--units: delay of that loop; one of its periods unless given")
      ->type_name("S");
  command
      ->add_option("--estimator-bandwidth", arguments->drive_loop.estimator_bandwidth,
                   "--units odrive: encoder.config.bandwidth; 1000 unless given;\n"
                   "moteus: 2 pi times pll_filter_hz; of 400 Hz unless given;\n"
                   "sensor.tracking_bandwidth of the file goes before these")
      ->type_name("RAD/S");
  command->add_option("-o,--output", arguments->output, "File to write; standard output unless given")
      ->type_name("FILE");
  command
      ->add_option("--contact", arguments->contact, "c: bilateral, a spring on both sides; unilateral: it only pushes")
      ->type_name("KIND")
      ->capture_default_str()
      ->check(CLI::IsMember({"bilateral", "unilateral"}));
  command->add_option("--stiffness", arguments->stiffness, "c, --units: K, instead of wall.stiffness")->type_name("K");
  command
      ->add_option("--safety-factor", arguments->safety_factor,
                   "c: K is this share of the limit for any passive user; where there\n"
                   "is none, of the critical stiffness with nobody holding and with\n"
                   "the file's user, the lesser; of the lower end\n"
                   "of the 95 % interval where the device has one;\n"
                   "chai3d: of both ceilings (default 0.5)")
      ->type_name("FACTOR");
  command->add_flag("--accept-doubt", arguments->accept_doubt,
                    "c, --units: write the wall of a doubtful device (its file says why)");
  command->footer(
      "Examples:\n"
      "  zwidth export devices/lhifam.toml --format octave --output lhifam.m\n"
      "  zwidth export devices/lhifam.toml --format python --output lhifam.py\n"
      "  zwidth export devices/lhifam.toml --format json --set loop.delay=0.25e-3\n"
      "  zwidth export devices/lhifam.toml --format c --stiffness 3000 --contact unilateral -o wall.c\n"
      "  zwidth export devices/lhifam.toml --format c --safety-factor 0.5 --output wall.c\n"
      "  zwidth export devices/lhifam.toml --format chai3d --safety-factor 0.5\n"
      "  zwidth export devices/lhifam.toml --units moteus --stiffness 3000 --set driver.travel=0.06\n"
      "  zwidth export devices/lhifam.toml --units odrive --stiffness 3000 --set wall.damping=5 \\\n"
      "    --set driver.travel=0.06 --drive-rate 8000 --estimator-bandwidth 2000");
  command->callback([arguments, command] {
    check(*arguments, *command);
    run_export(*arguments);
  });
}

}  // namespace zwidth::cli
