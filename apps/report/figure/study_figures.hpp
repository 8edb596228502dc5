#pragma once

#include <optional>
#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth::report {

// The pictures of a study. Throw OutputFailed. Nothing where there is nothing to draw.

/// How many units have which K_CR, and the share that reaches each, against the specification.
[[nodiscard]] std::optional<std::string> draw_study_distribution(const StudyRun& run, const Study& study,
                                                                 FigureFormat format);

/// The units in the plane of the two parameters that matter most, coloured by what limits them.
[[nodiscard]] std::optional<std::string> draw_study_scatter(const StudyRun& run, const Study& study,
                                                            FigureFormat format);

/// Share of the variance of K_CR by parameter: alone, and with others; without Sobol indices what a tighter tolerance
/// gains.
[[nodiscard]] std::optional<std::string> draw_study_tornado(const Study& study, FigureFormat format);

/// The walls (K, B) that 99 %, 50 % and 1 % of the units render, with the band of their intervals.
[[nodiscard]] std::optional<std::string> draw_study_regions(const StudyRun& run, const Study& study,
                                                            FigureFormat format);

}  // namespace zwidth::report
