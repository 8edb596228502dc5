#pragma once

#include <string_view>

#include "zwidth/model/wall_filter.hpp"

namespace zwidth {

/// The `type` of a filter as [[wall.filter]] and every report write it: "low_pass", "notch", "lead_lag", "biquad",
/// "digital".
[[nodiscard]] std::string_view wall_filter_type(WallFilter::Kind kind);

}  // namespace zwidth
