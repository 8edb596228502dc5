#pragma once

#include <vector>

#include "design/oscillation_causes.hpp"

namespace zwidth::internal {

// What moves that cause, each change alone and recomputed, by falling limit.
[[nodiscard]] std::vector<DiagnosisChange> changes_of(const ObservedLoop& loop, const OscillationCandidate& cause);

}  // namespace zwidth::internal
