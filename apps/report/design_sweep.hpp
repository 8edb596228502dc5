#pragma once

#include <string>
#include <vector>

#include "zwidth/design/parameter_sweep.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::report {

/// A device swept over one or two of its numbers, the input of every report of a sweep.
struct DesignSweep {
  Device device;
  ParameterSweep sweep;
};

/// The sweep as a table: every point of one parameter up to `most_rows`, evenly thinned beyond; of two, the least and
/// the largest K_CR with where they lie.
[[nodiscard]] std::string sweep_text(const DesignSweep& sweep);

}  // namespace zwidth::report
