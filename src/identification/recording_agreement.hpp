#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/fit_judgement.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

/// A device as one of several recordings alone has it.
struct OwnDevice {
  std::string source;  ///< the recording
  Device device;       ///< with its uncertainty
};

/// Why a device fitted to several recordings is none of theirs: two of them alone give critical stiffnesses whose 95 %
/// intervals, 1.25 times as wide, lie apart, with the one of all (`pooled`) between. Nothing where they agree, or do not say.
[[nodiscard]] std::optional<Finding> doubt_of_agreement(const std::vector<OwnDevice>& devices, const Device& pooled);

/// Doubts an answer otherwise sound that is an average of recordings that disagree: each alone is fitted from the answer
/// on.
void judge_agreement(Identification& result, std::span<const Recording> recordings, const IdentifyOptions& options);

/// Recordings that show another critical stiffness each fit no linear device; and a table may say what its own is worth.
void judge_measured(const MeasuredResponse& measured, Judgement& judgement);

}  // namespace zwidth::internal
