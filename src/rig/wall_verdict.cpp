#include "zwidth/rig/wall_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "zwidth/quantity.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth {
namespace {

constexpr double sure_deviations = 3.0;  // of a growth rate

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

void judge(RigLimit& limit, const Device& device) {
  limit.trust = limit.measured.trust;
  if (!limit.measured.at_most || limit.predicted.trust.refused()) return;
  const double at_most = *limit.measured.at_most;
  const double with_nobody = limit.limits.nobody.critical_stiffness;
  const double with_user = limit.limits.user ? limit.limits.user->critical_stiffness : with_nobody;
  const auto unit = units_of(device.parameters().motion).stiffness;
  const double promised = std::min(with_nobody, with_user);
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
