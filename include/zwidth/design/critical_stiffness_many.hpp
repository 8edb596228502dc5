#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/parameter_values.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// The critical stiffness of one of many devices, or why there is none.
struct CriticalStiffnessOfOne {
  StiffnessStatus status = StiffnessStatus::refused;  ///< whether there is a limit
  double stiffness = 0.0;                             ///< as in CriticalStiffness; NaN where refused
  double frequency = 0.0;                             ///< rad/s, of the limiting crossover; NaN unless finite
  std::optional<Oscillator> limited_by;               ///< absent unless finite
  Trust trust = {};                                   ///< of this device's answer
  std::string failure = {};  ///< the values make no device, or the computation failed; empty: neither
};

/// batch_stiffness() as one element per device: critical_stiffness() of the device with the i-th value of every key
/// set, for every i; values to 1e-12 relative, all else the same.
///
/// On all cores, whatever their number with the same results; `progress` may be called from any thread, never from two
/// at once. Values that make no device, and what does not converge, end nothing: that element is refused and says why.
/// Throws Error (invalid_argument) where find_problem() finds one.
[[nodiscard]] std::vector<CriticalStiffnessOfOne> critical_stiffness_many(const Device& device,
                                                                          std::span<const ParameterValues> changes,
                                                                          const Progress& progress = {});

}  // namespace zwidth
