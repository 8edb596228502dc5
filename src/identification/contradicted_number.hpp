#pragma once

#include <string>

#include "zwidth/finding.hpp"

namespace zwidth::internal {

/// A number of the structure that was not free, and what the recordings ask for instead.
struct ContradictedNumber {
  std::string key;
  double given = 0.0;  ///< SI
  double shown = 0.0;  ///< SI
};

/// Why a fit that takes it as given is not to be trusted, with the remedy.
[[nodiscard]] Finding contradiction(const ContradictedNumber& number);

}  // namespace zwidth::internal
