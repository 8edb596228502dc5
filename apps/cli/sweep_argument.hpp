#pragma once

#include <string>

#include "zwidth/design/parameter_sweep.hpp"

namespace zwidth::cli {

/// KEY=FIRST:LAST:COUNT, evenly spaced, or KEY=FIRST:LAST:COUNT:log, by equal factors; FIRST and LAST in SI units or with
/// one of the key's. Throws BadInput.
[[nodiscard]] SweepAxis sweep_axis(const std::string& argument, Motion motion);

}  // namespace zwidth::cli
