#pragma once

#include <string>

#include "report/document.hpp"
#include "report/text/findings_text.hpp"
#include "results/frf_json.hpp"

namespace zwidth::report {

/// The answer for a reader: critical stiffness with its interval, every crossover, what was done and what is doubtful.
[[nodiscard]] std::string frf_text(const MeasuredResponse& frf, const results::FrfUnits& units = {},
                                   ShownFindings shown = ShownFindings::all);

/// The same on a page, without the findings.
void add_response(Document& document, const MeasuredResponse& frf, const results::FrfUnits& units);

}  // namespace zwidth::report
