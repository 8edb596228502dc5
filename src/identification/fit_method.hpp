#pragma once

#include <span>

#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Whether the numbers of the structure are the device's.
[[nodiscard]] bool knows_structure(const IdentifyOptions& options);

/// Whether delay and lag are looked for.
[[nodiscard]] bool frees_lateness(const IdentifyOptions& options);

/// What is fitted: the motion where that is a position, long enough, of so few bodies as can be played; else lines of the response.
[[nodiscard]] IdentifyOptions::Method fit_method(std::span<const Recording> recordings, const Device& structure,
                                                 const IdentifyOptions& options);

/// Throws Error where the motion is asked for and there are too many bodies or too few samples.
void require_motion(std::span<const Recording> recordings, const Device& structure, const IdentifyOptions& options);

}  // namespace zwidth::internal
