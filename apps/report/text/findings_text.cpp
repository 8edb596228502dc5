#include "report/text/findings_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t most_shown = 3;

std::string remark_bullet(const Remark& remark) {
  return labelled(remark.severity == Remark::Severity::warning ? "  ! " : "  - ", remark_line(remark), 4);
}

/// What a reason is the sentence of; nothing where the library did not find it.
const Finding* finding_of(const std::string& reason, const Trust& trust) {
  const auto found = std::ranges::find(trust.findings, reason, [](const Finding& each) { return text(each); });
  return found == trust.findings.end() ? nullptr : &*found;
}

double limit_with(const Finding* finding) {
  if (finding == nullptr) return std::numeric_limits<double>::infinity();
  const auto found = std::ranges::find(finding->effect, "critical_stiffness", &Evidence::name);
  return found == finding->effect.end() ? std::numeric_limits<double>::infinity() : found->value;
}

/// The trust with the reasons that matter most first.
Trust most_severe_first(Trust trust) {
  const auto comes_first = [&](const std::string& a, const std::string& b) {
    const Finding* const of_a = finding_of(a, trust);
    const Finding* const of_b = finding_of(b, trust);
    const auto severity = [&](const Finding* finding) {
      if (finding != nullptr) return finding->severity;
      return trust.refused() ? Finding::Severity::refusal : Finding::Severity::doubt;
    };
    if (severity(of_a) != severity(of_b)) return severity(of_a) > severity(of_b);
    return limit_with(of_a) < limit_with(of_b);
  };
  std::vector<std::string> reasons = trust.reasons;
  std::ranges::stable_sort(reasons, comes_first);
  trust.reasons = std::move(reasons);
  return trust;
}

/// Whether the doubt rests on all that the remark rests on, or the other way round.
bool is_of_the_same(const Finding& doubt, const Finding& remark) {
  const auto holds_all = [](const std::vector<Evidence>& these, const std::vector<Evidence>& those) {
    return std::ranges::all_of(those,
                               [&](const Evidence& each) { return std::ranges::find(these, each) != these.end(); });
  };
  return doubt.code == remark.code && doubt.key == remark.key && doubt.subjects == remark.subjects &&
         (holds_all(doubt.evidence, remark.evidence) || holds_all(remark.evidence, doubt.evidence));
}

bool is_said(const Remark& remark, const Trust& trust) {
  const auto is_reason = [&](const std::string& each) {
    return std::ranges::find(trust.reasons, each) != trust.reasons.end();
  };
  if (is_reason(remark_line(remark))) return true;
  if (!remark.finding) return false;
  const Finding& finding = *remark.finding;
  const auto repeats = [&](const Subject& each) { return each.name == "reason" && is_reason(each.text); };
  return std::ranges::any_of(finding.subjects, repeats) ||
         std::ranges::any_of(trust.findings, [&](const Finding& doubt) { return is_of_the_same(doubt, finding); });
}

/// The trust in the fullest words that it is said in: a remark of the same finding may have a remedy besides.
Trust in_full(Trust trust, std::span<const Remark> remarks) {
  std::vector<std::string> reasons = trust.reasons;
  for (std::string& reason : reasons) {
    const Finding* const finding = finding_of(reason, trust);
    for (const Remark& remark : remarks) {
      if (finding == nullptr || !remark.finding || !is_of_the_same(*finding, *remark.finding)) continue;
      if (std::string line = remark_line(remark); line.size() > reason.size()) reason = std::move(line);
    }
  }
  trust.reasons = std::move(reasons);
  return trust;
}

/// How a file was read, which hardly ever matters: said last.
bool is_of_reading(const Remark& remark) {
  using enum FindingCode;
  constexpr std::array codes{text_table,          column_scaled_by_its_unit,
                             column_read_in_unit, rate_of_times,
                             rate_of_file,        twincat_scope_export,
                             codesys_trace,       controldesk_export,
                             objects_skipped,     labview_measurement_file,
                             not_numeric_skipped, complex_skipped,
                             no_signals_skipped,  single_numbers,
                             datasets_passed_over};
  return remark.finding && std::ranges::find(codes, remark.finding->code) != codes.end();
}

/// Those that the trust does not say, each once, warnings first.
std::vector<Remark> remaining(std::span<const Remark> remarks, const Trust& trust) {
  std::vector<Remark> rest;
  for (const Remark::Severity severity : {Remark::Severity::warning, Remark::Severity::note}) {
    for (const Remark& remark : remarks) {
      if (remark.severity != severity || is_said(remark, trust)) continue;
      const std::string line = remark_line(remark);
      if (std::ranges::find(rest, line, &remark_line) == rest.end()) rest.push_back(remark);
    }
  }
  std::ranges::stable_partition(
      rest, [](const Remark& each) { return each.severity == Remark::Severity::warning || !is_of_reading(each); });
  return rest;
}

}  // namespace

FindingsText findings_text(const Trust& trust, std::span<const Remark> remarks, ShownFindings shown) {
  const std::size_t most = shown == ShownFindings::three ? most_shown : std::numeric_limits<std::size_t>::max();
  Trust said = in_full(most_severe_first(trust), remarks);
  std::vector<Remark> rest = remaining(remarks, trust);
  const std::size_t all = said.reasons.size() + rest.size();
  const auto warnings = static_cast<std::size_t>(
      std::ranges::count(rest, Remark::Severity::warning, [](const Remark& each) { return each.severity; }));
  const std::size_t against = said.reasons.size() + warnings;
  said.reasons.resize(std::min(said.reasons.size(), most));
  rest.resize(std::min(rest.size(), most - said.reasons.size()));
  FindingsText found{trust_lines(said), ""};
  if (!rest.empty()) found.remarks += "\nRemarks\n" + remarks_text(rest);
  const std::size_t more = all - said.reasons.size() - rest.size();
  if (more > 0) {
    const std::size_t shown_against = std::min(against, most);
    found.remarks +=
        fmt::format("  ... {} more{}: add --explain\n", more,
                    against > shown_against ? fmt::format(", {} of them against the numbers", against - shown_against)
                                            : std::string());
  }
  return found;
}

std::string remarks_text(std::span<const Remark> remarks) {
  std::string lines;
  for (const Remark::Severity severity : {Remark::Severity::warning, Remark::Severity::note}) {
    for (const Remark& remark : remarks) {
      if (remark.severity == severity) lines += remark_bullet(remark);
    }
  }
  return lines;
}

}  // namespace zwidth::report
