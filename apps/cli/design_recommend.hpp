#pragma once

#include <CLI/App.hpp>
#include <optional>

#include "cli/design_notch.hpp"

namespace zwidth::cli {

/// What `design --recommend` asks for beside the goal and the margins, which it shares with --notch.
struct RecommendArguments {
  bool wanted = false;
  std::optional<double> quantisation_force;
};

/// Declares --recommend and --ripple; `arguments` must outlive the parsing.
void add_recommend_options(CLI::App& command, RecommendArguments& arguments);

/// Recommends the wall and prints the answer. Throws BadInput and WorkFailed.
void run_recommend(const CLI::App& command, const DeviceArguments& devices, const RecommendArguments& arguments,
                   const NotchArguments& shared, const OutputArguments& output);

}  // namespace zwidth::cli
