#pragma once

#include <string_view>

#include "zwidth/identification/measured_limit.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::cli {

/// A wall at which a device was seen to begin to oscillate, as --limit states it: "K=3, B=0, hz=40", in any order, each a number
/// in SI units or with its unit. K must be there; B is 0 and the frequency not known where they are not. Throws BadInput.
[[nodiscard]] MeasuredLimit measured_limit(std::string_view text, Motion motion);

}  // namespace zwidth::cli
