#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/identification/record_fit.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

// Who holds the device while it is recorded is fitted with it: the limit is then that of the device in this hand.

/// What is assumed of how the device was recorded: that the structure's operator held it; or, of a structure whose numbers are
/// unknown, that nobody did, for nothing tells a hand from the device; nor whether the force is the command or a load cell's.
[[nodiscard]] std::vector<Remark> remarks_of_experiment(const Device& structure, bool is_known,
                                                        const std::vector<std::string>& locked);

/// Why a known structure's held body looks held: heavier than it is, and damped several times as much.
[[nodiscard]] std::optional<Finding> doubt_of_hand(const Device& structure,
                                                   const std::vector<ParameterEstimate>& estimates,
                                                   const std::vector<std::string>& locked);

/// Stiffness of a spring from the held body to the ground that a structure without any lacks, N/m or N m/rad: with it
/// half of what is unexplained, or less, stays so. Nothing where next to nothing is unexplained, or bodies are locked.
[[nodiscard]] std::optional<double> missing_spring(const RecordFit& fit, const ParameterFitOptions& options);

}  // namespace zwidth::internal
