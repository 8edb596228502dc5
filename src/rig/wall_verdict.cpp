#include "zwidth/rig/wall_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "zwidth/quantity.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth {
namespace {

constexpr double sure_deviations = 3.0;      // of a growth rate
constexpr double harmless_error = 0.02;      // of a limit
constexpr double different_from_file = 0.1;  // of a limit, where its own interval does not decide

Finding unanswered(const RigSession& session, const Device& device) {
  const double share = static_cast<double>(session.timing.unanswered) /
                       static_cast<double>(std::max<std::uint64_t>(1, session.timing.cycles));
  Finding finding{.code = FindingCode::cycles_unanswered, .evidence = {{"share", share}}};
  const CriticalStiffness answered = critical_stiffness(device);
  if (answered.status != StiffnessStatus::finite) return finding;
  DeviceParameters parameters = device.parameters();
  parameters.loop.delay += share * parameters.loop.sampling_period;
  if (find_problem(parameters)) return finding;
  const CriticalStiffness later = critical_stiffness(Device(std::move(parameters)));
  if (later.status != StiffnessStatus::finite) return finding;
  finding.evidence.push_back({"error", std::max(0.0, 1.0 - later.stiffness / answered.stiffness)});
  return finding;
}

bool is_harmless(const Finding& unanswered) {
  return unanswered.evidence.size() > 1 && unanswered.evidence.back().value < harmless_error;
}

/// A limit that was measured with a force older than the device's.
void doubt_unanswered(const RigSession& session, const Device& device, Trust& trust) {
  if (session.timing.unanswered == 0) return;
  if (Finding finding = unanswered(session, device); !is_harmless(finding)) trust.doubt(std::move(finding));
}

/// Both numbers, where the limit measured is none of the file's, with nobody or with its user.
void compare(RigLimit& limit, Interval promised, const std::string& unit) {
  if (!limit.measured.stiffness) return;
  const double measured = *limit.measured.stiffness;
  const auto finding = [&](FindingCode code, double stiffness) {
    return Finding{.code = code,
                   .evidence = {{"measured", measured, unit},
                                {"promised", stiffness, unit},
                                {"difference", std::abs(measured / stiffness - 1.0)}}};
  };
  if (std::isfinite(promised.upper) && measured > (1.0 + different_from_file) * promised.upper) {
    limit.remarks.push_back(note(finding(FindingCode::measured_above_promise, promised.upper)));
  } else if (std::isfinite(promised.lower) && measured < (1.0 - different_from_file) * promised.lower) {
    limit.remarks.push_back(warning(finding(FindingCode::measured_below_promise, promised.lower)));
    limit.remarks.back().finding->effect = {{"critical_stiffness", measured}};
  }
}

}  // namespace

void judge(RigWall& wall) {
  wall.grows = wall.ring && wall.ring->growth_rate > sure_deviations * wall.ring->growth_deviation;
  if (wall.cut_duration > 0.0) {
    wall.trust.doubt({.code = FindingCode::force_kept_back, .evidence = {{"duration", wall.cut_duration, "s"}}});
  }
  if (wall.peak_force > 0.0 && wall.peak_position == 0.0) {
    wall.trust.doubt({.code = FindingCode::position_never_changed});
  }
  const bool has_stopped = wall.session.stop != StopReason::none;
  if (has_stopped) {
    wall.trust.doubt({.code = FindingCode::wall_cut_short, .subjects = {{"reason", explanation(wall.session)}}});
  }
  if (!wall.predicted_stable) return;
  if (!*wall.predicted_stable && has_stopped) {  // how far it grew until then does not matter
    wall.trust.doubt(
        {.code = FindingCode::unstable_and_stopped, .subjects = {{"holders", unstable_with(*wall.stable_for)}}});
  } else if (!*wall.predicted_stable && !wall.oscillates) {
    wall.trust.doubt({.code = wall.grows ? FindingCode::unstable_growing_slowly : FindingCode::unstable_unseen,
                      .subjects = {{"holders", unstable_with(*wall.stable_for)}}});
  }
  if (*wall.predicted_stable && (wall.oscillates || wall.grows)) {
    wall.trust.doubt({.code = FindingCode::stable_wall_oscillates});
  }
}

void remark(RigSession& session, const Device& device) {
  if (auto finding = finding_of(session)) session.remarks.push_back(warning(*std::move(finding)));
  if (session.timing.unanswered > 0 && session.stop == StopReason::none) {
    Finding finding = unanswered(session, device);
    session.remarks.push_back(is_harmless(finding) ? note(std::move(finding)) : warning(std::move(finding)));
  }
  if (session.drive_force_limit && session.limits.force && *session.drive_force_limit < *session.limits.force) {
    const std::string unit(units_of(device.parameters().motion).force);
    session.remarks.push_back(warning({.code = FindingCode::drive_limits_force,
                                       .evidence = {{"drive_limit", *session.drive_force_limit, unit},
                                                    {"force_limit", *session.limits.force, unit}}}));
  }
}

void judge(RigLimit& limit, const Device& device) {
  limit.trust = limit.measured.trust;
  doubt_unanswered(limit.session, device, limit.trust);
  if (limit.predicted.trust.refused()) return;
  const double with_nobody = limit.limits.nobody.critical_stiffness;
  const double with_user = limit.limits.user ? limit.limits.user->critical_stiffness : with_nobody;
  const std::string unit(units_of(device.parameters().motion).stiffness);
  const double promised = std::min(with_nobody, with_user);
  const Interval of_file{promised, std::max(with_nobody, with_user)};
  if (!limit.measured.at_most) return compare(limit, of_file, unit);
  const double at_most = *limit.measured.at_most;
  if (at_most < promised) {
    const std::vector<Evidence> evidence{{"at_most", at_most, unit}, {"promised", promised, unit}};
    const std::vector<Evidence> effect{{"critical_stiffness", at_most}};
    limit.remarks.push_back(warning({.code = FindingCode::device_bears_less, .evidence = evidence, .effect = effect}));
    limit.predicted.trust.doubt(
        {.code = FindingCode::prediction_above_measured, .evidence = evidence, .effect = effect});
    limit.trust.doubt({.code = FindingCode::file_promises_more, .evidence = evidence, .effect = effect});
  } else if (at_most < with_user) {
    limit.remarks.push_back(note(
        {.code = FindingCode::user_was_not_there,
         .evidence = {{"at_most", at_most, unit}, {"with_user", with_user, unit}, {"with_nobody", with_nobody, unit}},
         .key = "operator"}));
  } else {
    compare(limit, of_file, unit);
  }
}

void judge(RigMeasurement& measurement, const Device& device) {
  if (!measurement.response) {
    measurement.trust.refuse(
        {.code = FindingCode::record_cut_short, .subjects = {{"reason", explanation(measurement.session)}}});
    return;
  }
  if (std::ranges::any_of(device.bodies(), [](const Body& body) { return body.coulomb > 0.0; })) {
    measurement.response->trust.doubt({.code = FindingCode::friction_in_response});
  }
  measurement.trust.inherit(measurement.response->trust);
}

}  // namespace zwidth
