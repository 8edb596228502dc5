#pragma once

#include <string>

#include "zwidth/study/study_run.hpp"

namespace zwidth::report {

/// The study as a page: the yield, what it depends on, the worst unit, with figures. Throws OutputFailed.
[[nodiscard]] std::string study_page(const StudyRun& run, const Study& study);

/// The worst unit as a device file, named so, with the trust of the study. Requires that there is one.
[[nodiscard]] std::string worst_device_file(const StudyRun& run, const Study& study);

}  // namespace zwidth::report
