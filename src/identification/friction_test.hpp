#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// Dry friction that the motion of a fitted linear device leaves unexplained without it.
struct FrictionEvidence {
  std::string body;        ///< on which it explains most
  double force = 0.0;      ///< N or N m
  double deviation = 0.0;  ///< one standard deviation of it
};

/// In deviations; friction of more shows. Of 116 simulated records without friction the force that find_friction() gives
/// had a root mean square of 1.2 deviations and twice 4.1 at most.
inline constexpr double significant_friction = 4.8;

/// Looks for friction in the recorded motion.
///
///     y - y_M = sum_j dy_M/dp_j dp_j + start + constant force + sum over bodies F_c (response to -sign v_M),   in the
///     frequency domain, each line weighted by the rest around it
///
/// y_M, v_M: motion of the fitted device, as it was in the experiment, under the recorded force. Friction differs from
/// damping by its harmonics, so one record shows it where the noise allows. `free` are the keys of the fit; `lowest`
/// and `highest`, rad/s, bound the excited band. Nothing where the record is too short, or does not move.
struct FrictionQuestion {
  const Device& device;  ///< fitted
  const std::vector<std::string>& locked;
  const std::vector<std::string>& free;
  double sampling_period = 0.0;  ///< of the record, s
  double lowest = 0.0;
  double highest = 0.0;
};
[[nodiscard]] std::optional<FrictionEvidence> find_friction(const FrictionQuestion& question,
                                                            std::span<const double> force,
                                                            std::span<const double> position);

/// The fitted device as it was in the experiment: bodies locked, sampled at the record's rate, no wall's filters.
[[nodiscard]] Device device_in_experiment(const Device& fitted, const std::vector<std::string>& locked,
                                          double sampling_period);

/// Sensed positions of `size` samples from each initial state at 1, without a force.
[[nodiscard]] std::vector<std::vector<double>> free_motions(const Device& device, std::size_t size);

}  // namespace zwidth::internal
