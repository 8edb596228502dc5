#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/shot_device.hpp"
#include "identification/shot_model.hpp"
#include "identification/time_domain_start.hpp"
#include "identification/weak_force_test.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth::internal {

struct JudgedTimeFit {
  std::span<const Recording> recordings;
  const Device& structure;
  const TimeDomainOptions& options;
  std::span<const Shot> shots;
  bool is_turned = false;               ///< the position falls as the force rises
  std::optional<double> other_delay{};  ///< s; that the recordings show where another is given and not free
  std::optional<Finding> open_delay{};  ///< why one that nobody stated may lower the critical stiffness
  std::optional<LinearStiffness> linear{};
  std::optional<Finding> disagreement{};                      ///< of the recordings
  std::vector<ContradictedNumber> contradicted{};             ///< numbers of the structure that were not free
  std::vector<std::vector<WeakForceEvidence>> weak_forces{};  ///< of each recording
};

/// Analysis, basis, trust and remarks of a fit whose parameters and motions are given, and each motion's `unexplained`.
void judge_in_time(TimeDomainIdentification& fit, const JudgedTimeFit& judged);

}  // namespace zwidth::internal
