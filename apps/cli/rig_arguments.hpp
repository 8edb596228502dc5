#pragma once

#include <CLI/App.hpp>
#include <cstddef>
#include <optional>
#include <string>

#include "cli/device_arguments.hpp"
#include "cli/outputs.hpp"
#include "zwidth/rig/force_guard.hpp"

namespace zwidth::cli {

/// What is typed after `zwidth rig`; numbers that are absent have their default from the device.
struct RigArguments {
  std::string action;
  DeviceArguments devices;
  std::string driver = "simulated";
  bool accept_doubt = false;
  bool accept_unstable = false;
  bool no_watchdog = false;
  bool no_nudge = false;
  bool damper_on_drive = false;
  bool real_time = false;
  SafetyLimits limits;
  double start = 0.0;
  std::optional<double> amplitude;
  std::optional<double> duration;
  std::optional<double> lowest_hz;
  std::optional<double> highest_hz;
  std::optional<double> stiffness;
  std::optional<double> from;
  std::optional<double> ceiling;
  std::string contact = "bilateral";
  std::size_t trials = 4;
  double hysteresis = 0.0;
  bool seek_limit = false;
  std::string flight_record;
  std::string recording;
  std::string output_device;
  std::string delays;
  std::string report;
  OutputArguments output{.figure_option = "--figure"};
};

/// Declares the options; `arguments` must outlive the parsing.
void add_rig_arguments(CLI::App& command, RigArguments& arguments);

/// Throws BadInput for an option that the action does not have: it would be ignored.
void check_rig_arguments(const CLI::App& command, const RigArguments& arguments);

}  // namespace zwidth::cli
