#include "identification/verdict/verdict.hpp"

#include <cmath>
#include <string>

#include "identification/verdict/calibration.hpp"

namespace zwidth::internal {
namespace {

const char* name_of_kind(Omnibus::Kind kind) {
  switch (kind) {
    case Omnibus::Kind::correlated:
      return "correlated";
    case Omnibus::Kind::follows_force:
      return "follows_force";
    case Omnibus::Kind::nonlinear:
      return "nonlinear";
    case Omnibus::Kind::varies_with_speed:
      return "varies_with_speed";
  }
  return "correlated";
}

Finding open_interval(const LimitRange& limit) {
  constexpr double unknown = 1000.0;
  Finding found{
      .code = FindingCode::data_leave_interval_open,
      .evidence = {{"lower", limit.lower}, {"upper", limit.upper}, {"threshold", Calibration::widest_interval}},
      .effect = {{"critical_stiffness", limit.lower}}};
  if (limit.lower > 0.0) {
    const double factor = limit.upper / limit.lower;
    found.evidence.push_back(factor < unknown ? Evidence{"factor", factor} : Evidence{"more_than", unknown});
  }
  return found;
}

/// The limit with what stands out is not known: no effect.
Finding outstanding(const Omnibus& left, const std::vector<NamedRecord>& records) {
  const NamedRecord& record = records.at(left.record);
  const double from = static_cast<double>(left.first) * record.sampling_period;
  const double to = from + static_cast<double>(left.count) * record.sampling_period;
  return {.code = FindingCode::residual_stands_out,
          .evidence = {{"from", from, "s"},
                       {"to", to, "s"},
                       {"excess", left.excess},
                       {"p", left.p},
                       {"threshold", Calibration::least_p}},
          .subjects = {{"source", record.source}, {"kind", name_of_kind(left.clearest)}}};
}

}  // namespace

Trust verdict_of(const FittedLikelihood& fit) {
  Trust trust;
  for (const Finding& each : fit.contradictions) trust.refuse(each);
  if (!fit.limit)
    trust.refuse({.code = FindingCode::nothing_determined,
                  .subjects = {{"by", fit.records.size() == 1 ? "record" : "recordings"}}});
  if (trust.refused()) return trust;
  const bool is_narrow = fit.limit->upper <= Calibration::widest_interval * fit.limit->lower;
  if (!is_narrow) trust.doubt(open_interval(*fit.limit));
  if (fit.left && !(fit.left->p >= Calibration::least_p)) trust.doubt(outstanding(*fit.left, fit.records));
  return trust;
}

}  // namespace zwidth::internal
