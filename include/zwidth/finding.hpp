#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/finding_code.hpp"

namespace zwidth {

/// A number that a finding rests on.
struct Evidence {
  std::string_view name;       ///< "stiffness"; a literal
  double value = 0.0;          ///< in SI units
  std::string_view unit = {};  ///< "N/m"; empty for a count, a ratio, and where the sentence has its own
  [[nodiscard]] bool operator==(const Evidence&) const = default;
};

/// A text that a finding's sentence names: a body, a column, a file.
struct Subject {
  std::string_view name;  ///< "body"; a literal
  std::string text;       ///< "handle"
  [[nodiscard]] bool operator==(const Subject&) const = default;
};

/// Something that the library knows about an input or an answer, as data. Made once, where it is found, and carried by
/// everything downstream. Its sentence is words_of() of words/finding_text.hpp; no other room makes one.
struct Finding {
  /// From harmless to bad.
  enum class Severity : std::uint8_t {
    note,     ///< how the work was done
    warning,  ///< the answer is less than was asked for, or is not what it looks like
    doubt,    ///< the number stands, but something does not carry it: trust is doubtful
    refusal,  ///< no number is given: trust is refused
  };
  FindingCode code = FindingCode::stated;  ///< what was found
  std::vector<Evidence> evidence = {};     ///< the numbers, and the thresholds that they are held to
  std::vector<Subject> subjects = {};      ///< the names
  std::string key = {};                    ///< of the device file, that it concerns; empty for none
  std::vector<Evidence> effect = {};       ///< the limit with it: "critical_stiffness"; empty where that is not known
  Severity severity = Severity::note;      ///< of this one
  [[nodiscard]] bool operator==(const Finding&) const = default;
};

}  // namespace zwidth
