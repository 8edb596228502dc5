#pragma once

#include <string>

#include "zwidth/design/parameter_sweep.hpp"

namespace zwidth::report {

/// The sweep as a table: every point of one parameter up to `most_rows`, evenly thinned beyond; of two, the least and
/// the largest K_CR with where they lie.
[[nodiscard]] std::string sweep_text(const Device& device, const ParameterSweep& sweep);

}  // namespace zwidth::report
