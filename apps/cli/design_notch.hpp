#pragma once

#include <CLI/App.hpp>
#include <string>

#include "cli/device_arguments.hpp"

namespace zwidth::cli {

/// What `design --notch` asks for.
struct NotchArguments {
  bool wanted = false;
  std::string goal = "critical-stiffness";
  double drift_percent = 0.0;
  double gain_margin_db = 0.0;
  double phase_margin_deg = 0.0;
  std::string write;
};

/// Declares --notch and its options; `arguments` must outlive the parsing.
void add_notch_options(CLI::App& command, NotchArguments& arguments);

/// Throws BadInput for options of --notch that stand without it.
void refuse_notch_options(const CLI::App& command);

/// Where the answer goes beside the screen.
struct NotchOutput {
  std::string figure;  ///< empty: none
  bool json = false;
};

/// Designs the notch and prints the answer. Throws BadInput and WorkFailed.
void run_notch(const DeviceArguments& devices, const NotchArguments& arguments, const NotchOutput& output);

}  // namespace zwidth::cli
