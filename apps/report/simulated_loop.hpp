#pragma once

#include <string>
#include <vector>

#include "report/analysed_device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/simulation/trajectory.hpp"

namespace zwidth::report {

/// A simulated loop beside its linear answer: the input of the text, JSON, CSV and figure of `simulate`.
struct SimulatedLoop {
  AnalysedDevice analysed;
  SimulationOptions options;
  Simulation result;
  std::vector<Remark> remarks;  ///< what the verdict does not say: never touched, ended early, still pushed
};

/// Simulates and analyses the device; throws as simulate() and analyze() do.
[[nodiscard]] SimulatedLoop simulated_loop(AnalysedDevice analysed, const SimulationOptions& options,
                                           const Progress& progress = {});

/// "settles", "limit_cycle", ...
[[nodiscard]] std::string verdict_name(LoopVerdict verdict);

/// One sentence: what the loop did, with numbers and units.
[[nodiscard]] std::string verdict_sentence(const SimulatedLoop& loop);

/// What the linear analysis says of the same wall, and what it leaves out where the two differ.
[[nodiscard]] std::string linear_answer(const SimulatedLoop& loop);

}  // namespace zwidth::report
