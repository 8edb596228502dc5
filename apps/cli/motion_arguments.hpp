#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth::cli {

/// What sets a simulated device in motion, as typed on the command line.
struct MotionArguments {
  std::vector<std::string> starts;      ///< "BODY=M" or "M" for every body
  std::vector<std::string> velocities;  ///< the same
  std::string user_force;               ///< "step:5@0.1", ..., or a recording's name
  std::string force_column = "force";
  double force_scale = 1.0;
  double force_start = 0.0;           ///< s
  std::optional<double> force_rate;   ///< Hz
  const CLI::App* command = nullptr;  ///< whose options these are
};

/// Declares the options; `arguments` must outlive the parsing.
void add_motion_arguments(CLI::App& command, MotionArguments& arguments);

/// Sets initial motion and user force. Throws BadInput: a body that the device does not have, a value that is no
/// number, a recording that is refused.
void apply(const MotionArguments& arguments, const Device& device, SimulationOptions& options);

}  // namespace zwidth::cli
