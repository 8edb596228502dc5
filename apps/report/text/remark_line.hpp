#pragma once

#include <string>

#include "zwidth/remark.hpp"

namespace zwidth::report {

/// "what; meaning", or "what" alone.
[[nodiscard]] std::string remark_line(const Remark& remark);

}  // namespace zwidth::report
