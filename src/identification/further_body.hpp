#pragma once

#include <optional>

#include "identification/motion_start.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// A structure with one body more than was given, and what is free in it.
struct FurtherBody {
  Device structure;
  FreeNumbers free;
};

/// The structure with a body behind the held one by a link of its own, whose mass, spring and dampers are free. Where one body is
/// driven and sensed, any one more mode of it is that of such a body.
///
/// Nothing for a transfer function, where the held body stood still or an operator held it, or of more bodies than can be played.
[[nodiscard]] std::optional<FurtherBody> with_further_body(const Device& structure, const FreeNumbers& free,
                                                           const FrequencyResponse& response);

/// Whether the body that with_further_body() added swings against the held one, within the band of the response: one that creeps
/// stands for anything slow.
[[nodiscard]] bool is_mode(const DeviceParameters& device, const FrequencyResponse& response);

/// What was found of the body that with_further_body() added, the last one of `device`.
[[nodiscard]] Finding further_body_fitted(const DeviceParameters& device);

}  // namespace zwidth::internal
