#pragma once

#include "report/text/text_table.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::report {

/// What the file says, so that a printed report can be traced.
[[nodiscard]] TextTable device_table(const Device& of);

}  // namespace zwidth::report
