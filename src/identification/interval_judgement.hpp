#pragma once

#include <optional>
#include <span>

#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Narrows the interval of K_CR to what the response shows where it shows the limit by itself (`is_measured`), and doubts one
/// that is not to be relied on. Returns what judge_unseen_limit() does: a device that explains the record better.
[[nodiscard]] std::optional<Device> judge_interval(Identification& result, bool is_measured,
                                                   std::span<const Recording> recordings,
                                                   const IdentifyOptions& options);

}  // namespace zwidth::internal
