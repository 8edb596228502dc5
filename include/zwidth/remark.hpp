#pragma once

#include <optional>
#include <string>

#include "zwidth/finding.hpp"

namespace zwidth {

/// Something about an input or a result that its user should know.
struct Remark {
  /// How much it matters.
  enum class Severity {
    note,     ///< how the work was done ("segments of 4096 samples, Hann, half overlapping")
    warning,  ///< the result may be wrong or is less than asked for
  };
  Severity severity = Severity::note;   ///< of this one
  std::string what;                     ///< one line: "force is constant from 3.2 s to 4.1 s"
  std::string consequence;              ///< what it means for the result; may be empty
  std::string remedy = {};              ///< what to do about it; may be empty
  std::optional<Finding> finding = {};  ///< what these are the words of, where the library found it
};

/// A finding as a remark, in the words of words/finding_text.hpp.
[[nodiscard]] Remark note(Finding finding);
[[nodiscard]] Remark warning(Finding finding);  ///< of severity warning

/// "what; consequence; remedy", without those that are empty.
[[nodiscard]] std::string remark_line(const Remark& remark);

}  // namespace zwidth
