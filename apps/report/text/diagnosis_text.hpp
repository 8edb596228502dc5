#pragma once

#include <string>

#include "zwidth/design/diagnosis.hpp"

namespace zwidth::report {

/// What the oscillation is, what it is not, and what moves it: at most 100 columns.
[[nodiscard]] std::string diagnosis_text(const Device& device, const Diagnosis& diagnosis);

}  // namespace zwidth::report
