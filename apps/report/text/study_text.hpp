#pragma once

#include <string>
#include <vector>

#include "report/text/text_table.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth::report {

/// The answer of `study` in words and tables.
[[nodiscard]] std::string study_text(const StudyRun& run, const Study& study);

// Its parts, shared with the page. Tables have their headings alone where there is nothing to say.

/// "98.73 % of the units reach 3 kN/m (95 % interval 98.49 % to 98.94 %)"; or that nothing is specified.
[[nodiscard]] std::string yield_sentence(const StudyRun& run, const Study& study);
[[nodiscard]] TextTable quantile_table(const StudyRun& run, const Study& study);
/// By parameter: Sobol indices, and what half its spread gains.
[[nodiscard]] TextTable parameter_table(const Study& study);
[[nodiscard]] TextTable cluster_table(const Study& study);
/// The stiffest and the most damped walls of each share of the units, where they are asked for.
[[nodiscard]] TextTable region_table(const StudyRun& run, const Study& study);
/// "Walls that shares of 1000 units render, B in steps of 2.5 N s/m"; empty unless asked for.
[[nodiscard]] std::string region_heading(const StudyRun& run, const Study& study);
/// The worst device: its limit and its numbers. Empty where there is none.
[[nodiscard]] std::string worst_sentence(const StudyRun& run, const Study& study);
/// Which tolerance to tighten first. Empty where none gains.
[[nodiscard]] std::string tightening_sentence(const Study& study);

/// The share of failures by importance sampling. Empty unless asked for.
[[nodiscard]] std::string rare_sentence(const Study& study);

/// "vibration mode 1", "no wall is stable", ...
[[nodiscard]] std::string mechanism_of(StiffnessStatus status, int mode);

}  // namespace zwidth::report
