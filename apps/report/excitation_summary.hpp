#pragma once

#include <optional>
#include <string>

#include "zwidth/identification/excitation.hpp"

namespace zwidth::report {

/// An excitation as made, and what it does to a device where one is given.
struct CheckedExcitation {
  ExcitationOptions options;
  Excitation excitation;
  Motion motion = Motion::linear;  ///< of the device; linear without one
  std::string device;              ///< its name
  std::optional<ExcitationCheck> check;
};

/// "linear chirp, 10 to 200 Hz": the signal in a few words, as a title.
[[nodiscard]] std::string excitation_title(const ExcitationOptions& options);

/// A few lines: the signal with its peak and crest factor, every note, the device's largest motion.
[[nodiscard]] std::string excitation_text(const CheckedExcitation& checked);

}  // namespace zwidth::report
