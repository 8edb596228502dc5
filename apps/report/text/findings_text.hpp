#pragma once

#include <span>
#include <string>

#include "zwidth/remark.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::report {

/// How many of its findings a text shows.
enum class ShownFindings {
  three,  ///< those that matter most, and how many more there are
  all,
};

/// What was found about an answer, each once: refusals and doubts, the lowest limit with one of them first, then warnings, then
/// notes.
struct FindingsText {
  std::string against;  ///< the verdict, and below it what speaks against the answer; empty where that is sound
  std::string reasons;  ///< those lines without the verdict
  std::string remarks;  ///< the rest as "Remarks", and how many more there are; may be empty
};

[[nodiscard]] FindingsText findings_text(const Trust& trust, std::span<const Remark> remarks, ShownFindings shown);

/// One wrapped line per remark, "  - what; meaning", warnings first.
[[nodiscard]] std::string remarks_text(std::span<const Remark> remarks);

}  // namespace zwidth::report
