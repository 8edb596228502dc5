#include "identification/verdict/verdict.hpp"

#include "identification/verdict/calibration.hpp"
#include "identification/verdict/finding_of_fit.hpp"

namespace zwidth::internal {

bool is_explained(const VerdictInput& fit) {
  return !fit.motion_tells_none && !(fit.omnibus && stands_out(*fit.omnibus));
}

Verdict verdict_of(const VerdictInput& fit) {
  Verdict verdict;
  Trust& trust = verdict.trust;
  for (const Finding& each : fit.contradictions) trust.refuse(each);
  if (!fit.limit || !(fit.limit->upper > 0.0)) trust.refuse(undetermined(fit));
  for (const Finding& each : fit.doubts_of_data) trust.doubt(each);
  if (fit.motion_tells_none) trust.doubt({.code = FindingCode::motion_tells_no_limit});
  if (trust.refused()) return verdict;
  const bool is_narrow = fit.limit->upper <= Calibration::widest_interval * fit.limit->lower;
  if (!is_narrow) trust.doubt(open_interval(fit));
  if (was_stopped(fit)) trust.doubt(stopped_search(fit));
  if (fit.omnibus && stands_out(*fit.omnibus)) trust.doubt(outstanding(*fit.omnibus, fit.records));
  if (fit.delay && contradicts(*fit.delay)) {
    const bool matters = fit.delay->stiffness < fit.limit->lower || fit.delay->stiffness > fit.limit->upper;
    if (matters)
      trust.doubt(contradicted(*fit.delay));
    else
      verdict.remarks.push_back(warning(contradicted(*fit.delay)));
  }
  if (fit.force_has_one_size) verdict.remarks.push_back(note({.code = FindingCode::force_of_one_size}));
  if (fit.further_body) verdict.remarks.push_back(note(*fit.further_body));
  for (const RivalEstimate& each : fit.rivals) {
    if (auto found = shown_rival(each, fit)) verdict.remarks.push_back(note(*std::move(found)));
  }
  if (fit.place && (fit.place->limiting > fit.place->highest || fit.place->limiting < fit.place->lowest))
    verdict.remarks.push_back(note(outside_band(*fit.place)));
  return verdict;
}

}  // namespace zwidth::internal
