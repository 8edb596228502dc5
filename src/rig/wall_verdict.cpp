#include "zwidth/rig/wall_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "zwidth/quantity.hpp"
#include "zwidth/stability/held_wall.hpp"

namespace zwidth {
namespace {

constexpr double sure_deviations = 3.0;  // of a growth rate

}  // namespace

void judge(RigWall& wall) {
  wall.grows = wall.ring && wall.ring->growth_rate > sure_deviations * wall.ring->growth_deviation;
  if (wall.cut_duration > 0.0) {
    wall.trust.doubt(fmt::format(
        "force was kept back for {}, by its limit or its ramp: the wall that was felt is softer than this one",
        quantity(wall.cut_duration, "s")));
  }
  if (wall.peak_force > 0.0 && wall.peak_position == 0.0) {
    wall.trust.doubt(
        "the position never changed under force: check encoder, [driver], and that the drive moves its motor");
  }
  const bool has_stopped = wall.session.stop != StopReason::none;
  if (has_stopped) {
    wall.trust.doubt("the rig stopped before the wall's time was over: " + explanation(wall.session));
  }
  if (!wall.predicted_stable) return;
  if (!*wall.predicted_stable && has_stopped) {  // how far it grew until then does not matter
    wall.trust.doubt(
        fmt::format("the wall is UNSTABLE by linear analysis, {}: render softer", unstable_with(*wall.stable_for)));
  } else if (!*wall.predicted_stable && !wall.oscillates) {
    wall.trust.doubt(
        fmt::format("the wall is UNSTABLE by linear analysis, {}: that {} does not make it stable; render softer",
                    unstable_with(*wall.stable_for),
                    wall.grows ? "its oscillation grew too slowly to be taken away"
                               : "no oscillation was seen to grow while it ran"));
  }
  if (*wall.predicted_stable && (wall.oscillates || wall.grows)) {
    wall.trust.doubt(
        "an oscillation grew in a wall that is stable by linear analysis: the device is not that of its file; identify "
        "it, and render softer until then");
  }
}

void judge(RigLimit& limit, const Device& device) {
  limit.trust = limit.measured.trust;
  if (!limit.measured.at_most || limit.predicted.trust.refused()) return;
  const double at_most = *limit.measured.at_most;
  const double with_nobody = limit.limits.nobody.critical_stiffness;
  const double with_user = limit.limits.user ? limit.limits.user->critical_stiffness : with_nobody;
  const auto unit = units_of(device.parameters().motion).stiffness;
  const auto text_of = [&](double stiffness) {
    return std::isfinite(stiffness) ? quantity(stiffness, unit) : std::string("every stiffness");
  };
  const double promised = std::min(with_nobody, with_user);
  if (at_most < promised) {
    limit.remarks.push_back(
        {Remark::Severity::warning,
         fmt::format("UNSAFE: the device bears less than its file promises: {} at most, as measured, for {}",
                     text_of(at_most), text_of(promised)),
         "walls in between are called stable, and shake on the device",
         "identify the device, and render softer until then"});
    limit.predicted.trust.doubt(fmt::format(
        "the device on the rig bears {} at most, less than this: its file is not that of the device; identify it",
        text_of(at_most)));
    limit.trust.doubt(fmt::format(
        "the device's file promises {}, more than was measured: identify the device before any of its limits is used",
        text_of(promised)));
  } else if (at_most < with_user) {
    limit.remarks.push_back(
        {Remark::Severity::note,
         fmt::format("the limit measured, {} at most, lies below that with the file's user, {}, not below that with "
                     "nobody holding, {}",
                     text_of(at_most), text_of(with_user), text_of(with_nobody)),
         "whoever held the device, if anybody did, was not the file's user",
         "leave the user out of the file for a rig that nobody holds"});
  }
}

void judge(RigMeasurement& measurement, const Device& device) {
  if (!measurement.response) {
    measurement.trust.refuse("the rig stopped before its record was whole: " + explanation(measurement.session));
    return;
  }
  if (std::ranges::any_of(device.bodies(), [](const Body& body) { return body.coulomb > 0.0; })) {
    measurement.response->trust.doubt(
        "the device has dry friction, which a response shows as damping: large motion has less of it, and a lower "
        "limit; excite more strongly and see whether the limit falls");
  }
  measurement.trust.inherit(measurement.response->trust);
}

}  // namespace zwidth
