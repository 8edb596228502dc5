#pragma once

#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

/// The verdict into the device's [uncertainty], so that its file keeps it.
[[nodiscard]] Device with_trust(const Device& device, const Trust& trust);

/// A reason to doubt what its file is asked beyond the answer.
[[nodiscard]] Device with_reason(const Device& device, const Finding& finding);

/// Keys of the bodies held still of a structure whose values stand for nothing: no recording of that experiment shows them.
[[nodiscard]] std::vector<std::string> unseen_placeholders(const std::vector<std::string>& locked);

/// What the structure only assumes (Uncertainty::assumed) and the data do not determine stays assumed in the fitted device, as
/// `placeholders` do, and makes `trust` doubtful. Where the structure's file is doubtful or refused and a mass, spring or damper
/// of it is not determined by the data, the answer is so too.
void keep_what_is_assumed(const Device& structure, std::span<const ParameterEstimate> estimates,
                          std::vector<std::string> placeholders, Device& fitted, Trust& trust);

}  // namespace zwidth::internal
