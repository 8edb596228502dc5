#include "report/text/findings_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/ranked_findings.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t most_shown = 3;

std::string bullet_line(const std::string& line, bool is_warning) {
  return labelled(is_warning ? "  ! " : "  - ", line, 4);
}

}  // namespace

FindingsText findings_text(const Trust& trust, std::span<const Remark> remarks, ShownFindings shown) {
  const std::vector<RankedFinding> found = most_important(trust, remarks);
  const std::size_t most = shown == ShownFindings::three ? std::min(most_shown, found.size()) : found.size();
  Trust said{.verdict = trust.verdict};
  std::string rest;
  for (const RankedFinding& each : std::span(found).first(most)) {
    const Finding::Severity severity = each.finding.severity;
    if (severity >= Finding::Severity::doubt) {
      said.reasons.push_back(text(each.words));
    } else {
      rest += bullet_line(text(each.words), severity == Finding::Severity::warning);
    }
  }
  FindingsText texts{trust_lines(said), reason_lines(said), rest.empty() ? "" : "\nRemarks\n" + rest};
  if (found.size() == most) return texts;
  const auto against = std::ranges::count_if(std::span(found).subspan(most), [](const RankedFinding& each) {
    return each.finding.severity >= Finding::Severity::warning;
  });
  texts.remarks += fmt::format("  ... {} more{}: add --explain\n", found.size() - most,
                               against > 0 ? fmt::format(", {} of them against the numbers", against) : std::string());
  return texts;
}

std::string remarks_text(std::span<const Remark> remarks) {
  std::string lines;
  for (const Remark::Severity severity : {Remark::Severity::warning, Remark::Severity::note}) {
    for (const Remark& remark : remarks) {
      if (remark.severity == severity) lines += bullet_line(remark_line(remark), severity == Remark::Severity::warning);
    }
  }
  return lines;
}

}  // namespace zwidth::report
