#pragma once

#include <vector>

#include "design/diagnosis/oscillation_causes.hpp"
#include "design/synthesis/absolute_stability_check.hpp"

namespace zwidth::internal {

// What moves that cause, each change alone and recomputed, by falling limit; what lowers the limit with any passive user
// last. A cause that does not fit moves as it would were it otherwise.
[[nodiscard]] std::vector<DiagnosisChange> changes_of(const ObservedLoop& loop, const OscillationCandidate& cause,
                                                      const AbsoluteStabilityCheck& users);

}  // namespace zwidth::internal
