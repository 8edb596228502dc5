#include "zwidth/trust.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

bool has(const std::vector<std::string>& reasons, const std::string& reason) {
  return std::ranges::find(reasons, reason) != reasons.end();
}

void add(Trust& trust, Trust::Verdict least, Finding finding) {
  trust.verdict = std::max(trust.verdict, least);
  finding.severity = least == Trust::Verdict::refused ? Finding::Severity::refusal : Finding::Severity::doubt;
  assert(finding.severity <= worst_severity(finding.code));
  std::string reason = text(finding);
  if (has(trust.reasons, reason)) return;
  trust.reasons.push_back(std::move(reason));
  trust.findings.push_back(std::move(finding));
}

}  // namespace

void Trust::doubt(Finding finding) { add(*this, Verdict::doubtful, std::move(finding)); }

void Trust::refuse(Finding finding) { add(*this, Verdict::refused, std::move(finding)); }

void Trust::inherit(const Trust& source) {
  verdict = std::max(verdict, source.verdict);
  for (const Finding& finding : source.findings) {
    std::string reason = text(finding);
    if (has(reasons, reason)) continue;
    reasons.push_back(std::move(reason));
    findings.push_back(finding);
  }
  for (const std::string& reason : source.reasons) {
    if (has(reasons, reason)) continue;
    add(*this, source.verdict, {.code = FindingCode::stated, .subjects = {{"reason", reason}}});
  }
}

}  // namespace zwidth
