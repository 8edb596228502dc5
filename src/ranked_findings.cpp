#include "zwidth/ranked_findings.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <utility>

namespace zwidth {
namespace {

double limit_with(const Finding& finding) {
  const auto found = std::ranges::find(finding.effect, "critical_stiffness", &Evidence::name);
  return found == finding.effect.end() ? std::numeric_limits<double>::infinity() : found->value;
}

/// How a file was read, which hardly ever matters.
bool is_of_reading(FindingCode code) {
  using enum FindingCode;
  constexpr std::array codes{text_table,          column_scaled_by_its_unit,
                             column_read_in_unit, rate_of_times,
                             rate_of_file,        twincat_scope_export,
                             codesys_trace,       controldesk_export,
                             objects_skipped,     labview_measurement_file,
                             not_numeric_skipped, complex_skipped,
                             no_signals_skipped,  single_numbers,
                             datasets_passed_over};
  return std::ranges::find(codes, code) != codes.end();
}

/// What comes first is less.
auto rank(const RankedFinding& ranked) {
  const Finding& finding = ranked.finding;
  const bool speaks_against = finding.severity >= Finding::Severity::doubt;
  return std::tuple(-static_cast<int>(finding.severity), speaks_against ? limit_with(finding) : 0.0,
                    finding.severity == Finding::Severity::note && is_of_reading(finding.code));
}

/// Whether one of them rests on all that the other rests on.
bool is_of_the_same(const Finding& doubt, const Finding& remark) {
  const auto holds_all = [](const std::vector<Evidence>& these, const std::vector<Evidence>& those) {
    return std::ranges::all_of(those,
                               [&](const Evidence& each) { return std::ranges::find(these, each) != these.end(); });
  };
  return doubt.code == remark.code && doubt.key == remark.key && doubt.subjects == remark.subjects &&
         (holds_all(doubt.evidence, remark.evidence) || holds_all(remark.evidence, doubt.evidence));
}

/// Whether the remark says what the trust says, or repeats one of its reasons.
bool is_said(const Remark& remark, const Trust& trust) {
  if (!remark.finding) return false;
  const auto repeats = [&](const Subject& each) {
    return each.name == "reason" && std::ranges::find(trust.reasons, each.text) != trust.reasons.end();
  };
  return std::ranges::any_of(remark.finding->subjects, repeats) ||
         std::ranges::any_of(trust.findings,
                             [&](const Finding& each) { return is_of_the_same(each, *remark.finding); });
}

RankedFinding ranked_of(const Remark& remark) {
  Finding finding =
      remark.finding.value_or(Finding{.code = FindingCode::stated, .subjects = {{"reason", remark_line(remark)}}});
  finding.severity =
      remark.severity == Remark::Severity::warning ? Finding::Severity::warning : Finding::Severity::note;
  return {std::move(finding), {remark.what, remark.consequence, remark.remedy}};
}

}  // namespace

std::vector<RankedFinding> most_important(const Trust& trust, std::span<const Remark> remarks, std::size_t count) {
  Trust all;  // a finding for each reason
  all.inherit(trust);
  std::vector<RankedFinding> found;
  std::vector<std::string> said;
  const auto add = [&](RankedFinding each) {
    std::string line = text(each.words);
    if (std::ranges::find(said, line) != said.end()) return;
    said.push_back(std::move(line));
    found.push_back(std::move(each));
  };
  for (const Finding& each : all.findings) add({each, words_of(each)});
  for (const Remark& remark : remarks) {
    if (!is_said(remark, all)) add(ranked_of(remark));
  }
  std::ranges::stable_sort(found, {}, &rank);
  found.resize(std::min(found.size(), count));
  return found;
}

}  // namespace zwidth
