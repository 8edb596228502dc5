#include "cli/rig_arguments.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "cli/option_refusal.hpp"
#include "cli/subcommand.hpp"
#include "rig/open_driver.hpp"
#include "zwidth/words/drive_problem_text.hpp"

namespace zwidth::cli {
namespace {

constexpr const char* safety_group = "Safety";

/// An option, and the actions that have it: "measure identify ".
struct OptionOfActions {
  std::string_view option;
  std::string_view actions;
};

constexpr std::array<OptionOfActions, 17> options_of_actions{
    {{"--amplitude", "measure identify relay wall limit "},
     {"--duration", "check measure identify relay wall limit "},
     {"--lowest-hz", "measure identify "},
     {"--highest-hz", "measure identify "},
     {"--stiffness", "wall "},
     {"--accept-unstable", "wall "},
     {"--contact", "wall "},
     {"--damper-on-drive", "relay wall limit "},
     {"--from", "limit "},
     {"--ceiling", "limit "},
     {"--trials", "relay "},
     {"--hysteresis", "relay "},
     {"--seek-limit", "relay "},
     {"--recording", "measure identify "},
     {"--output-device", "check identify "},
     {"--delays", "check "},
     {"--figure", "measure identify relay wall limit "}}};

void add_work_options(CLI::App& command, RigArguments& arguments) {
  const auto add = [&](const char* name, auto& value, const char* what, const char* type) {
    return command.add_option(name, value, what)->type_name(type);
  };
  add("--amplitude", arguments.amplitude,
      "Force of excitation, relay or knock; else what moves the\ndevice by 1 mm (1 mrad), at most a third of its limit",
      "F");
  add("--duration", arguments.duration,
      "Of check, wall or excitation, of a trial of relay or limit;\nelse by the device", "S");
  add("--lowest-hz", arguments.lowest_hz, "measure, identify: lower end of the band", "HZ");
  add("--highest-hz", arguments.highest_hz, "measure, identify: upper end of the band", "HZ");
  add("--stiffness", arguments.stiffness, "wall: K, instead of wall.stiffness", "K");
  add("--contact", arguments.contact, "wall: bilateral, a spring on both sides; unilateral: it only pushes", "KIND")
      ->capture_default_str()
      ->check(CLI::IsMember({"bilateral", "unilateral"}));
  command.add_flag(
      "--damper-on-drive", arguments.damper_on_drive,
      "relay, wall, limit: the drive closes the damper, as [loop.damper]\nstates, and gets the spring's force alone");
  add("--from", arguments.from, "limit: first stiffness; else half of what is predicted", "K");
  add("--ceiling", arguments.ceiling, "limit: the most that is tried; else half above what is predicted", "K");
  add("--trials", arguments.trials, "relay: number of trials", "N")->capture_default_str()->check(CLI::Range(1, 1000));
  add("--hysteresis", arguments.hysteresis, "relay: m or rad", "M")->capture_default_str();
  command.add_flag("--seek-limit", arguments.seek_limit,
                   "relay: begin so that the limit's oscillation is found,\nnot a faster one; else as relay begins");
  add("--start", arguments.start, "Where all bodies of a simulated device start, at rest, m or rad", "M")
      ->capture_default_str();
}

void add_safety_options(CLI::App& command, RigArguments& arguments) {
  const auto add = [&](const char* name, auto& value, const char* what, const char* type) {
    return command.add_option(name, value, what)->type_name(type)->group(safety_group);
  };
  add("--force-limit", arguments.limits.force, "Force beyond is cut off; else actuator.force_limit", "F");
  add("--position-limit", arguments.limits.position, "Distance from the start at which the force goes to zero", "M");
  add("--velocity-limit", arguments.limits.velocity, "m/s or rad/s, at which the force goes to zero", "V");
  add("--saturation", arguments.limits.saturation_duration, "How long the force may be cut off", "S")
      ->capture_default_str();
  add("--missed-cycles", arguments.limits.missed_cycles,
      "Cycles in a row that may come late or bring no position; else\n25 ms of them, three at least; beyond three at "
      "most the\ndrive's watchdog",
      "N");
  add("--ramp", arguments.limits.ramp, "Over which the force grows at the start", "S")->capture_default_str();
  const auto flag = [&](const char* name, bool& value, const char* what) {
    command.add_flag(name, value, what)->group(safety_group);
  };
  flag("--accept-doubt", arguments.accept_doubt, "Act on a device that is doubtful (its file says why)");
  flag("--accept-unstable", arguments.accept_unstable, "wall: render one that is unstable by linear analysis");
  flag("--no-nudge", arguments.no_nudge,
       "On a drive, leave out the nudge that tells its sign before any\nwall; where a wall ran before");
  flag("--no-watchdog", arguments.no_watchdog, "Act on a drive whose firmware has no watchdog, or none proved");
}

}  // namespace

void add_rig_arguments(CLI::App& command, RigArguments& arguments) {
  command
      .add_option("ACTION", arguments.action,
                  "check: link, rate, latency, watchdog; measure: excite and\n"
                  "record; identify: the device from that; relay: the relay\n"
                  "experiment; wall: render the wall; limit: raise the\n"
                  "stiffness until an oscillation grows")
      ->type_name("")
      ->required()
      ->check(CLI::IsMember({"check", "measure", "identify", "relay", "wall", "limit"}));
  add_device_arguments(command, arguments.devices, FileCount::one);
  command
      .add_option(
          "--driver", arguments.driver,
          "simulated, udp:HOST:PORT, or a serial line: odrive:PORT,\nsimplefoc:PORT, moteus:PORT, vesc:PORT, "
          "or serial:PORT with a\nsketch around firmware/zwidth_serial.h; or a CAN bus behind a serial\nport with "
          "an SLCAN adapter or fdcanusb, or a SocketCAN interface:\nodrive-can:ADAPTER, moteus-can:ADAPTER, "
          "vesc-can:ADAPTER")
      ->type_name("DRIVER")
      ->capture_default_str();
  command.add_flag("--real-time", arguments.real_time, "Keep the clock with a simulated device too");
  add_work_options(command, arguments);
  add_safety_options(command, arguments);
  add_output_options(command, arguments.output,
                     {.figure = "All but check: also draw what was found: .svg, .png or .pdf"});
  const auto file = [&](const char* name, std::string& value, const char* what) {
    command.add_option(name, value, what)->type_name("FILE");
  };
  file("--flight-record", arguments.flight_record,
       "Write the last 60 s of every signal as CSV, however it ended;\nwithout it only where it stopped, and it says "
       "where");
  file("--recording", arguments.recording, "measure, identify: write force and position as CSV");
  file("--output-device", arguments.output_device,
       "identify: write the device file; check: that of FILE with the\ndelay as measured on a drive");
  file("--delays", arguments.delays,
       "check: write how often each delay was measured on a drive, which\na study takes as a distribution of "
       "loop.delay");
  file("--report", arguments.report, "Write all of it as one HTML page");
}

void check_rig_arguments(const CLI::App& command, const RigArguments& arguments) {
  for (const auto& [option, actions] : options_of_actions) {
    if (command.count(std::string(option)) == 0) continue;
    if (actions.find(arguments.action + " ") == std::string_view::npos) {
      throw BadInput(option, fmt::format("is not for rig {}", arguments.action));
    }
  }
  if (arguments.driver == "simulated") {
    for (const char* option : {"--output-device", "--delays"}) {
      if (arguments.action != "check" || command.count(option) == 0) continue;
      throw BadInput(option, "a simulated device has the delay of its file: check a drive");
    }
    return;
  }
  if (const auto problem = rig::find_driver_name_problem(arguments.driver)) {
    throw BadInput("--driver", fmt::format("{}: {}", arguments.driver, text(*problem)));
  }
  if (arguments.damper_on_drive) {
    constexpr std::pair<std::string_view, std::string_view> options[] = {{"damper_on_drive", "--damper-on-drive"}};
    if (const auto problem = rig::find_damper_problem(arguments.driver)) refuse(*problem, options);
  }
  for (const char* option : {"--real-time", "--start"}) {
    if (command.count(option) > 0) throw BadInput(option, "is for a simulated device");
  }
}

}  // namespace zwidth::cli
