#pragma once

#include <string>
#include <string_view>

#include "zwidth/stability/holding.hpp"

namespace zwidth::report {

/// A limit of one holder: "135 N m/rad", "none: no wall is stable from K = 0 on", "every wall is stable", "refused".
[[nodiscard]] std::string holder_limit_text(const HolderLimit& limit, std::string_view unit);

}  // namespace zwidth::report
