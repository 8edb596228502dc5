#pragma once

#include <string>

#include "zwidth/study/study_run.hpp"

namespace zwidth::report {

/// The answer of `study` in words and tables.
[[nodiscard]] std::string study_text(const StudyRun& run, const Study& study);

/// The same as a page, with figures. Throws OutputFailed.
[[nodiscard]] std::string study_page(const StudyRun& run, const Study& study);

/// The worst unit as a device file, named so, with the trust of the study. Requires that there is one.
[[nodiscard]] std::string worst_device_file(const Study& study);

/// "vibration mode 1", "no wall is stable", ...
[[nodiscard]] std::string oscillator_of(StiffnessStatus status, int mode);

}  // namespace zwidth::report
