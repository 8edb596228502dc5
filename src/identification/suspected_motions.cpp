#include "identification/suspected_motions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "identification/motion_residuals.hpp"

namespace zwidth::internal {
namespace {

using Signal = std::vector<double>;

Signal growing_delay(std::span<const double> position) {
  Signal motion(position.size(), 0.0);
  const double middle = 0.5 * static_cast<double>(position.size());
  for (std::size_t k = 1; k + 1 < position.size(); ++k) {
    motion[k] = -(static_cast<double>(k) - middle) * 0.5 * (position[k + 1] - position[k - 1]);
  }
  return motion;
}

Signal difference(const Signal& a, const Signal& b) {
  Signal result(a.size());
  std::ranges::transform(a, b, result.begin(), [](double x, double y) { return x - y; });
  return result;
}

Signal motion_of_body(const Device& device, std::size_t body, std::span<const double> force) {
  DeviceParameters seen = device.parameters();
  seen.loop.sensed = body;
  return motion_of(Device(std::move(seen)), force);
}

/// Between -1 and 1: built up over `length` after each turn; at once where that is 0.
Signal rubbing(const Signal& stretch, double length) {
  Signal force(stretch.size(), 0.0);
  double built = 0.0;
  for (std::size_t k = 0; k + 1 < stretch.size(); ++k) {
    const double moved = stretch[k + 1] - stretch[k];
    const double sign = moved > 0.0 ? 1.0 : moved < 0.0 ? -1.0 : 0.0;
    built = length > 0.0 ? sign + (built - sign) * std::exp(-std::abs(moved) / length) : sign;
    force[k] = -built;
  }
  return force;
}

/// Of a damping that is 1 N s/m or N m s/rad more after the share of the record than before, and 0 in the mean.
Signal changing_damping(const Signal& motion, double share, double period) {
  Signal force(motion.size(), 0.0);
  const auto turn = static_cast<std::size_t>(share * static_cast<double>(motion.size()));
  for (std::size_t k = 0; k + 1 < motion.size(); ++k) {
    force[k] = (k < turn ? 1.0 - share : -share) * (motion[k + 1] - motion[k]) / period;
  }
  return force;
}

double rms(const Signal& signal) {
  double squares = 0.0;
  for (const double each : signal) squares += each * each;
  return std::sqrt(squares / static_cast<double>(signal.size()));
}

}  // namespace

std::vector<SuspectedMotion> suspected_motions(const Device& device, std::span<const double> force,
                                               std::span<const double> position) {
  std::vector<SuspectedMotion> suspects;
  suspects.push_back({SuspectedMotion::Kind::clock_skew, growing_delay(position)});
  for (const Link& link : device.links()) {
    const Signal stretch =
        difference(motion_of_body(device, link.second, force), motion_of_body(device, link.first, force));
    const double typical = rms(stretch);
    if (!(typical > 0.0)) continue;
    for (const double share : {0.0, 0.1, 0.5, 2.0}) {
      const Signal acting = rubbing(stretch, share * typical);
      suspects.push_back(
          {SuspectedMotion::Kind::link_friction, difference(motion_of(pushed_at(device, link.second), acting),
                                                            motion_of(pushed_at(device, link.first), acting))});
    }
  }
  for (std::size_t body = 0; body < device.bodies().size(); ++body) {
    const Signal motion = motion_of_body(device, body, force);
    if (!(rms(motion) > 0.0)) continue;  // locked
    for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
      const Signal acting = changing_damping(motion, share, device.loop().sampling_period);
      suspects.push_back({SuspectedMotion::Kind::changing_damping, motion_of(pushed_at(device, body), acting),
                          device.bodies()[body].name, share});
    }
  }
  return suspects;
}

}  // namespace zwidth::internal
