#pragma once

#include <string>

#include "zwidth/identification/identification.hpp"

namespace zwidth::internal {

/// Why no critical stiffness is sound where its interval is open (zwidth::is_open()), with the remedy.
[[nodiscard]] std::string open_interval_reason(const StiffnessInterval& interval);

/// A normal distribution around a parameter that the data hardly show draws devices that contradict them. Where the
/// response shows the critical stiffness by itself, which does not hang on such parameters, they are taken as known;
/// unless many of those devices are limited by a softer crossover outside the lines, where the response shows nothing.
void narrow_interval(Identification& result);

}  // namespace zwidth::internal
