#pragma once

#include <span>
#include <vector>

#include "identification/verdict/verdict.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/frequency_response.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Why no answer of these recordings is one of the structure's loop.
[[nodiscard]] std::vector<Finding> doubts_of_recordings(std::span<const Recording> recordings, const Device& structure,
                                                        const IdentifyOptions& options);

/// What the data say before anything is fitted: `doubts`, a clipped signal, a turned sign.
[[nodiscard]] VerdictInput before_fit(const MeasuredResponse& measured, const Device& structure,
                                      std::vector<Finding> doubts);

/// Whether fewer numbers of a response stand out of their noise than are fitted.
[[nodiscard]] bool is_drowned(const FrequencyResponse& response, const Device& structure,
                              const IdentifyOptions& options);

/// Whether fitted motions are the recorded ones to a tenth: of one that no force makes, states and a constant force leave more.
[[nodiscard]] bool follows_force(std::span<const FittedMotion> motions);

}  // namespace zwidth::internal
