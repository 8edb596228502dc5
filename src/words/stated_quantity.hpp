#pragma once

#include <string>
#include <string_view>

namespace zwidth::internal {

/// "0.0012 N m"; where neither N nor N m is stated, "0.0012 N (N m where it turns)".
[[nodiscard]] std::string force_in_words(double force, std::string_view force_unit);

/// "23 N m/rad"; where no motion is stated, "23 N/m (where it turns 23 N m/rad)".
[[nodiscard]] std::string stiffness_in_words(double stiffness, std::string_view force_unit,
                                             std::string_view length_unit);

}  // namespace zwidth::internal
