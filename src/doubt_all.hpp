#pragma once

#include <algorithm>
#include <string>

#include "zwidth/trust.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::internal {

/// What speaks against `source` speaks against `trust` too, which it does not refuse: a doubt each.
inline void doubt_all(const Trust& source, Trust& trust) {
  for (const std::string& reason : source.reasons) {
    const auto finding =
        std::ranges::find_if(source.findings, [&](const Finding& each) { return text(each) == reason; });
    const Finding stated{.code = FindingCode::stated, .subjects = {{"reason", reason}}};
    trust.doubt(finding != source.findings.end() ? *finding : stated);
  }
}

}  // namespace zwidth::internal
