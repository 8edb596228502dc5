#include "identification/verdict/finding_of_fit.hpp"

#include <cmath>
#include <string>

#include "identification/model/number_keys.hpp"
#include "identification/verdict/calibration.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

const char* name_of_kind(Omnibus::Kind kind) {
  switch (kind) {
    case Omnibus::Kind::nonlinear:
      return "nonlinear";
    case Omnibus::Kind::records_differ:
      return "records_differ";
    case Omnibus::Kind::follows_force:
      break;
  }
  return "follows_force";
}

/// The share of the interval, by logarithms, that a rival leaves open.
bool opens_most(const RivalEstimate& rival, const Interval& limit) {
  constexpr double share = 0.25;
  if (!rival.stiffness_interval) return false;
  const double open = std::log(rival.stiffness_interval->upper / rival.stiffness_interval->lower);
  return !(limit.lower > 0.0) || open >= share * std::log(limit.upper / limit.lower);
}

}  // namespace

Finding undetermined(const VerdictInput& fit) {
  return {.code = FindingCode::nothing_determined,
          .subjects = {{"by", fit.records.size() <= 1 ? "record" : "recordings"}}};
}

Finding open_interval(const VerdictInput& fit) {
  constexpr double unknown = 1000.0;
  const Interval& limit = *fit.limit;
  Finding found{
      .code = FindingCode::data_leave_interval_open,
      .evidence = {{"lower", limit.lower}, {"upper", limit.upper}, {"threshold", Calibration::widest_interval}},
      .effect = {{"critical_stiffness", limit.lower}}};
  if (limit.lower > 0.0) {
    const double factor = limit.upper / limit.lower;
    found.evidence.push_back(factor < unknown ? Evidence{"factor", factor} : Evidence{"more_than", unknown});
  }
  if (fit.rivals.empty() || !opens_most(fit.rivals.front(), limit)) return found;
  const RivalEstimate& rival = fit.rivals.front();
  found.subjects.push_back({"rival", rival.code});
  found.subjects.push_back({"parameter", rival.parameter});
  found.evidence.push_back({"with_lower", rival.stiffness_interval->lower, units_of(fit.motion).stiffness});
  found.evidence.push_back({"with_upper", rival.stiffness_interval->upper, units_of(fit.motion).stiffness});
  return found;
}

bool was_stopped(const VerdictInput& fit) {
  return fit.last_change > Calibration::most_change * std::log(fit.limit->upper / fit.limit->lower);
}

Finding stopped_search(const VerdictInput& fit) {
  return {.code = FindingCode::search_stopped,
          .evidence = {{"moved", std::expm1(fit.last_change)},
                       {"share", fit.last_change / std::log(fit.limit->upper / fit.limit->lower)},
                       {"threshold", Calibration::most_change}}};
}

bool stands_out(const Omnibus& omnibus) { return !(omnibus.p >= Calibration::least_p); }

Finding outstanding(const Omnibus& omnibus, const std::vector<NamedRecord>& records) {
  const NamedRecord& record = records.at(omnibus.record);
  Finding found{.code = FindingCode::residual_stands_out,
                .evidence = {{"excess", omnibus.excess}, {"p", omnibus.p}, {"threshold", Calibration::least_p}},
                .subjects = {{"source", record.source}, {"kind", name_of_kind(omnibus.clearest)}}};
  if (omnibus.count == 0) return found;  // of lines
  const double from = static_cast<double>(omnibus.first) * record.sampling_period;
  const double to = from + static_cast<double>(omnibus.count) * record.sampling_period;
  found.evidence.push_back({"from", from, "s"});
  found.evidence.push_back({"to", to, "s"});
  return found;
}

bool contradicts(const GivenDelay& delay) {
  constexpr double significant = 4.0;
  constexpr double notable = 0.05;  // of the sampling period
  const double beyond = std::abs(delay.shown - delay.given);
  return beyond > significant * delay.deviation && beyond > notable * delay.sampling_period;
}

Finding contradicted(const GivenDelay& delay) {
  return {.code = FindingCode::delay_contradicts_structure,
          .evidence = {{"shown", delay.shown}, {"given", delay.given}, {"deviation", delay.deviation}},
          .key = key_of_delay,
          .effect = {{"critical_stiffness", delay.stiffness}}};
}

std::optional<Finding> shown_rival(const RivalEstimate& rival, const VerdictInput& fit) {
  constexpr double significant = 3.0;
  const bool is_friction = rival.code == "coulomb_friction" || rival.code == "link_friction";
  if (!is_friction && rival.code != "constant_force") return std::nullopt;
  if (!rival.standard_deviation || !(std::abs(rival.value) > significant * *rival.standard_deviation))
    return std::nullopt;
  Finding found{.code = is_friction ? FindingCode::dry_friction_fitted : FindingCode::constant_force,
                .evidence = {{"force", rival.value}, {"deviation", *rival.standard_deviation}},
                .subjects = {{"unit", rival.unit}}};
  if (const auto body = body_of_friction(rival.parameter)) {
    found.subjects.push_back({"body", *body});
    return found;
  }
  if (const auto link = link_of_friction(rival.parameter)) {
    found.subjects.push_back({"link", *link});
    return found;
  }
  for (std::size_t record = 0; record < fit.records.size(); ++record) {
    if (rival.parameter != constant_force_key(record)) continue;
    found.subjects.push_back({"source", fit.records[record].source});
    return found;
  }
  return std::nullopt;
}

Finding outside_band(const LimitPlace& place) {
  return {.code = FindingCode::limit_outside_band,
          .evidence = {{"frequency", place.limiting}, {"lowest", place.lowest}, {"highest", place.highest}},
          .subjects = {{"side", place.limiting > place.highest ? "above" : "below"}}};
}

}  // namespace zwidth::internal
