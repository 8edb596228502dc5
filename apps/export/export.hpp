#pragma once

#include <string>

#include "zwidth/stability/device_model.hpp"

namespace zwidth::report {

/// A script for GNU Octave with its control package, that runs as it is: `sysc`, `sysd`,
/// sampled_response(model, w), wall_controller(wall, T, K) and closed_loop_poles(sysd, wall, K).
[[nodiscard]] std::string export_octave(const DeviceModel& model);

/// A script for Python 3 with SciPy, that runs and imports as it is: `sysc`, `sysd`,
/// sampled_response(w), wall_controller(K) and closed_loop_poles(K).
[[nodiscard]] std::string export_python(const DeviceModel& model);

}  // namespace zwidth::report
