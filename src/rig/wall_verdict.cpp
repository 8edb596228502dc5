#include "zwidth/rig/wall_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "zwidth/quantity.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth {
namespace {

constexpr double sure_deviations = 3.0;  // of a growth rate
constexpr double harmless_error = 0.02;  // of a limit
constexpr double same_filter = 0.02;     // of a drive's filter of the position
constexpr double quick_filter = 100.0;  // rad a period: up to Nyquist's frequency it takes a thousandth of the position
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
void compare(RigLimit& limit, Interval promised, std::string_view unit) {
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

/// What a drive's own filter of the position takes of a limit is predicted where the file says it.
void remark_filter(RigSession& session, const DeviceParameters& file) {
  const auto add = [&](Evidence of_drive, double of_file, const char* key) {
    Finding finding{.code = FindingCode::drive_filters_position, .evidence = {of_drive}, .key = key};
    if (of_file > 0.0) finding.evidence.push_back({"of_file", of_file});
    if (session.drive.is_filter_assumed) finding.evidence.push_back({"assumed", 1.0});
    session.remarks.push_back(warning(std::move(finding)));
  };
  const double bandwidth = session.drive.tracking_bandwidth.value_or(0.0);
  const double of_file = file.sensor.tracking_bandwidth;
  const bool is_felt = bandwidth > 0.0 && bandwidth * file.loop.sampling_period < quick_filter;
  const bool is_stated = session.drive.is_filter_assumed && of_file > 0.0;
  if (is_felt && !is_stated && std::abs(of_file - bandwidth) > same_filter * bandwidth) {
    add({"bandwidth", bandwidth}, of_file, "sensor.tracking_bandwidth");
  }
  const double lag = session.drive.position_lag.value_or(0.0);
  if (lag > 0.0 && file.actuator.time_constant < (1.0 - same_filter) * lag) {
    add({"lag", lag}, file.actuator.time_constant, "actuator.time_constant");
  }
}

void remark_drive(RigSession& session, const Device& device) {
  const DriveSettings& drive = session.drive;
  const std::string_view unit = units_of(device.parameters().motion).force;
  if (drive.force_limit && session.limits.force && *drive.force_limit < *session.limits.force) {
    session.remarks.push_back(warning(
        {.code = FindingCode::drive_limits_force,
         .evidence = {{"drive_limit", *drive.force_limit, unit}, {"force_limit", *session.limits.force, unit}}}));
  }
  if (drive.least_force.value_or(0.0) > 0.0) {
    session.remarks.push_back(warning(
        {.code = FindingCode::drive_drops_small_forces,
         .evidence = {{"force", *drive.least_force, unit}, {"current", drive.least_current.value_or(0.0), "A"}}}));
  }
  remark_filter(session, device.parameters());
  if (drive.are_unknown) {
    session.remarks.push_back(
        warning({.code = FindingCode::drive_settings_unknown, .subjects = {{"firmware", drive.firmware}}}));
  }
  if (drive.mode_after_watchdog) {
    session.remarks.push_back(note({.code = FindingCode::drive_after_watchdog,
                                    .evidence = {{"mode", static_cast<double>(*drive.mode_after_watchdog)}}}));
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
  remark_drive(session, device);
}

void judge(RigLimit& limit, const Device& device) {
  limit.trust = limit.measured.trust;
  doubt_unanswered(limit.session, device, limit.trust);
  if (limit.predicted.trust.refused()) return;
  const double with_nobody = limit.limits.nobody.critical_stiffness;
  const double with_user = limit.limits.user ? limit.limits.user->critical_stiffness : with_nobody;
  const std::string_view unit = units_of(device.parameters().motion).stiffness;
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
