#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/simulation/simulate.hpp"

namespace zwidth::internal {

/// Runs a second controller on the unrounded positions beside the loop's own: the difference of their commands is what
/// the encoder's steps do, whatever else the wall does.
class QuantisationForceObserver {
 public:
  /// Keeps the last quarter of `samples`.
  QuantisationForceObserver(const Device& device, const HybridLoopOptions& loop, std::size_t samples);

  /// The unrounded position of one sample, and the command that the loop's controller made of the rounded one.
  void note(double position, double command);

  /// Absent without encoder or wall, with faults (the instant of measuring is not known then), where the damper runs
  /// apart (it reads between), for fewer than two cycles, and where the command does not change in the last tenth of the run.
  [[nodiscard]] std::optional<QuantisationForce> found() const;

 private:
  bool observes_ = false;
  SampledController exact_;
  double limit_ = 0.0;
  double period_ = 0.0;
  std::size_t first_ = 0;
  std::size_t noted_ = 0;
  double last_command_ = 0.0;
  std::size_t changes_ = 0;      ///< of the command, in that quarter
  std::size_t last_change_ = 0;  ///< the sample after which there was none
  std::vector<double> differences_;
};

}  // namespace zwidth::internal
