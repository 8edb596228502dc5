#include "zwidth/rig/wall_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "zwidth/quantity.hpp"

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
    wall.trust.doubt("the wall is UNSTABLE by linear analysis: render softer");
  } else if (!*wall.predicted_stable && !wall.oscillates) {
    wall.trust.doubt(
        fmt::format("the wall is UNSTABLE by linear analysis: that {} does not make it stable; render softer",
                    wall.grows ? "its oscillation grew too slowly to be taken away"
                               : "no oscillation was seen to grow while it ran"));
  }
  if (*wall.predicted_stable && (wall.oscillates || wall.grows)) {
    wall.trust.doubt(
        "an oscillation grew in a wall that is stable by linear analysis: the device is not that of its file; identify "
        "it, and render softer until then");
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
