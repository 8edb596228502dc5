#pragma once

#include <vector>

#include "design/any_user_judge.hpp"
#include "design/oscillation_causes.hpp"

namespace zwidth::internal {

// What moves that cause, each change alone and recomputed, by falling limit; what lowers the limit with any passive user
// last. A cause that does not fit moves as it would were it otherwise.
[[nodiscard]] std::vector<DiagnosisChange> changes_of(const ObservedLoop& loop, const OscillationCandidate& cause,
                                                      const AnyUserJudge& users);

}  // namespace zwidth::internal
