#pragma once

#include <vector>

#include "design/absolute_stability_check.hpp"
#include "design/oscillation_causes.hpp"

namespace zwidth::internal {

// What moves that cause, each change alone and recomputed, by falling limit; what lowers the limit with any passive user
// last. A cause that does not fit moves as it would were it otherwise.
[[nodiscard]] std::vector<DiagnosisChange> changes_of(const ObservedLoop& loop, const OscillationCandidate& cause,
                                                      const AbsoluteStabilityCheck& users);

}  // namespace zwidth::internal
