#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "cli/device_arguments.hpp"
#include "cli/outputs.hpp"

namespace zwidth::cli {

/// What `design --notch` asks for; goal, modal frequency uncertainty, margins and `write` are of --recommend too.
struct NotchArguments {
  bool wanted = false;
  std::optional<std::string> goal;
  std::optional<double> drift_percent;  // not given: the library's
  std::optional<double> gain_margin_db;
  std::optional<double> phase_margin_deg;
  bool far_from_modes = false;
  bool lower_absolute_stability_limit = false;
  std::string write;
};

/// Declares --notch and its options; `arguments` must outlive the parsing.
void add_notch_options(CLI::App& command, NotchArguments& arguments);

/// Throws BadInput for options of --notch that stand without it (and without --recommend); --goal may be that of another
/// form.
void refuse_notch_options(const CLI::App& command, bool goal_is_used);

/// Designs the notch and prints the answer. Throws BadInput and WorkFailed.
void run_notch(const DeviceArguments& devices, const NotchArguments& arguments, const OutputArguments& output);

}  // namespace zwidth::cli
