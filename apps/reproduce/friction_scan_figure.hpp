#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "reproduce/table_2.hpp"

namespace zwidth::report {

/// Errors of the simulated Table II against the level of friction: frequency above, margin below. Throws OutputFailed.
[[nodiscard]] std::string draw_friction_scan(const std::string& title, const Table2& table, FigureFormat format);

}  // namespace zwidth::report
