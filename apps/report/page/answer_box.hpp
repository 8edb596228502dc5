#pragma once

#include <string>

#include "report/analysed_device.hpp"

namespace zwidth::report {

/// What a page says first, as markup: whether the answer is sound; the stiffest stable spring with nobody holding, with the file's
/// user and with any passive user; the other walls; the interval.
[[nodiscard]] std::string answer_box(const AnalysedDevice& analysed);

}  // namespace zwidth::report
