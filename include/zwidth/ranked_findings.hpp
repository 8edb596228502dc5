#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "zwidth/finding.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/trust.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {

/// A finding about an answer with its words.
struct RankedFinding {
  Finding finding;     ///< `stated` where the library found none; its severity tells a reason from a remark
  FindingWords words;  ///< what is said of it
};

/// The findings about an answer, each once, those that matter most first, at most `count`: refusals, doubts by the lowest limit
/// with one of them, warnings, notes, and last how a file was read. A remark of what is a doubt already is left out.
[[nodiscard]] std::vector<RankedFinding> most_important(const Trust& trust, std::span<const Remark> remarks = {},
                                                        std::size_t count = std::numeric_limits<std::size_t>::max());

}  // namespace zwidth
