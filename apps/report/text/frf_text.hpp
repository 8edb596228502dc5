#pragma once

#include <span>
#include <string>

#include "results/frf_json.hpp"

namespace zwidth::report {

/// The answer for a reader: critical stiffness with its interval, every crossover, what was done and what is doubtful.
[[nodiscard]] std::string frf_text(const MeasuredResponse& frf, const results::FrfUnits& units = {});

/// One wrapped line per remark, "  - what; meaning", warnings first.
[[nodiscard]] std::string remarks_text(std::span<const Remark> remarks);

}  // namespace zwidth::report
