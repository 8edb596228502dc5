#pragma once

#include <cstddef>
#include <span>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {

/// The periods that a periodic record is averaged over.
struct PeriodicRecord {
  std::size_t period = 0;   ///< samples, >= 2
  std::size_t skipped = 0;  ///< leading periods left out; at least two remain
  /// What to do about leading periods in which the transient still shows.
  enum class Transient { skip, remark } transient = Transient::remark;
};

/// frequency_response() by averaging over periods, from force to `output` as it is (a velocity is not turned into a
/// position). The arguments are valid and the force is not constant.
[[nodiscard]] FrequencyResponse periodic_response(std::span<const double> force, std::span<const double> output,
                                                  double sampling_period, const PeriodicRecord& record,
                                                  const FrequencyResponseOptions& options, const Progress& progress);

}  // namespace zwidth::internal
