#pragma once

#include <optional>

#include "identification/found_device.hpp"
#include "identification/verdict/verdict.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The answer: the device with its analysis, and the verdict on it, of what was found and is known of the fit.
[[nodiscard]] Identification judged_identification(const MeasuredResponse& measured, const Device& structure,
                                                   const IdentifyOptions& options, std::optional<FoundDevice> found,
                                                   VerdictInput fit, IdentifyOptions::Method method);

}  // namespace zwidth::internal
