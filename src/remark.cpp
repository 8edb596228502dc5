#include "zwidth/remark.hpp"

#include <cassert>
#include <utility>

#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

Remark remark_of(Finding finding, Remark::Severity severity) {
  assert(finding.severity <= worst_severity(finding.code));
  FindingWords words = words_of(finding);
  return {severity, std::move(words.what), std::move(words.consequence), std::move(words.remedy), std::move(finding)};
}

}  // namespace

Remark note(Finding finding) {
  finding.severity = Finding::Severity::note;
  return remark_of(std::move(finding), Remark::Severity::note);
}

Remark warning(Finding finding) {
  finding.severity = Finding::Severity::warning;
  return remark_of(std::move(finding), Remark::Severity::warning);
}

std::string remark_line(const Remark& remark) { return text({remark.what, remark.consequence, remark.remedy}); }

}  // namespace zwidth
