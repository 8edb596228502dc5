#pragma once

#include <optional>
#include <string>

#include "zwidth/identification/identification.hpp"

namespace zwidth::internal {

/// The structure of an answer with one body more, on a link to any of its bodies, where that explains the response notably
/// better (explains_notably_more()).
struct FurtherBody {
  ParameterFit fit;  ///< the further body and its link are the last
  /// The structure as it was, fitted from there with the further body's mass on the one that it hangs on, where that too
  /// explains notably more: the answer's search had ended beside the device.
  std::optional<Device> without;
};

/// Of an answer otherwise sound: a mode above the band bends the response within it before what is left stands out of the noise
/// at any line. The mode begins at 1.3 and at 3 times the highest line, damped by 0.1 % of the critical damping; its mass and
/// its link are free beside the numbers of the fit. Nothing of a response without variances.
[[nodiscard]] std::optional<FurtherBody> find_further_body(const Identification& result,
                                                           const IdentifyOptions& options);

[[nodiscard]] Finding doubt_of_further_body(const FurtherBody& further, const Identification& result);

}  // namespace zwidth::internal
