#pragma once

#include <string>

#include "zwidth/identification/excitation.hpp"

namespace zwidth::report {

/// "linear chirp, 10 to 200 Hz": the signal in a few words, as a title.
[[nodiscard]] std::string excitation_title(const ExcitationOptions& options);

/// A few lines: the signal with its peak and crest factor, every note, the device's largest motion.
[[nodiscard]] std::string excitation_text(const Excitation& excitation);

}  // namespace zwidth::report
