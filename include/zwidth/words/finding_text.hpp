#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "zwidth/finding.hpp"

namespace zwidth {

/// The code's name, as documents give it: "wall_not_surely_stable".
[[nodiscard]] std::string_view name_of(FindingCode code);

/// The worst that is made of a finding of this code; where less hangs on it, it is less.
[[nodiscard]] Finding::Severity worst_severity(FindingCode code);

/// A finding in words.
struct FindingWords {
  std::string what;         ///< one line: "force is constant from 3.2 s to 4.1 s"
  std::string consequence;  ///< what it means for the answer; may be empty
  std::string remedy;       ///< what to do about it; may be empty
};

/// The words of a finding, from its code and its numbers. Throws Error (invalid_argument) where its sentence names a
/// number or a text that the finding does not hold.
[[nodiscard]] FindingWords words_of(const Finding& finding);

/// "what; consequence; remedy", without those that are empty.
[[nodiscard]] std::string text(const FindingWords& words);
[[nodiscard]] std::string text(const Finding& finding);                 ///< of words_of(finding)
[[nodiscard]] std::string text(const std::optional<Finding>& finding);  ///< the same; empty where there is none

}  // namespace zwidth
