// The limit over all passive users of a damper that runs faster than its spring: random devices, each held by the user that
// interpolates what its limit's frequency asks for.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "property/random_two_rates.hpp"
#include "property/two_rate_worst_user.hpp"
#include "stability/users/any_user_limit.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth {
namespace {

constexpr double hardly = 1e-3;         // of the limit, on either side
constexpr double beyond_noise = 1e-12;  // of |z| - 1, of eigenvalues

// Whether the loop with that user is stable hardly below this stiffness and unstable hardly above.
bool loses_stability_there(const Device& held, double stiffness) {
  return test::excess_as_it_runs(held, stiffness * (1.0 + hardly)) > beyond_noise &&
         test::excess_as_it_runs(held, stiffness * (1.0 - hardly)) < -beyond_noise;
}

bool is_reached(const Device& device, const AbsoluteStabilityLimit& limit) {
  if (limit.needs_no_user) return loses_stability_there(device, limit.stiffness);
  const test::TwoRateReactances reactances(device);
  const double period = device.loop().sampling_period;
  std::vector<double> angles{std::min(limit.frequency * period, std::numbers::pi)};
  // Towards w = 0 users are extreme, and the limit hardly differs.
  if (limit.frequency == 0.0) angles = {3e-3, 1e-2, 3e-2, 0.1, 1e-3};
  for (const double angle : angles) {
    for (const std::size_t most : {1U, 2U, 4U, 8U, 16U, 32U, 90U}) {
      const test::Reactances at = reactances.towards(limit.stiffness, angle / period, most);
      // The lightest is the narrowest: of what can be solved the heaviest are tried.
      int tried = 0;
      for (double share = 0.3; share > 1e-6 && tried < 4; share *= 0.3) {
        const std::optional<UserNetwork> user = test::interpolating_user(at, share);
        if (!user) continue;
        if (loses_stability_there(held_by(device, *user), limit.stiffness)) return true;
        ++tried;
      }
    }
  }
  return false;
}

// The delays apart by whole periods of the damper, no user of the file's.
std::optional<Device> with_whole_delays(const Device& drawn) {
  const DamperTiming damper = damper_timing(drawn.loop());
  DeviceParameters parameters = device_without_user(drawn).parameters();
  Loop& loop = parameters.loop;
  if (!(damper.sampling_period < loop.sampling_period) || !(parameters.wall.damping > 0.0)) return std::nullopt;
  const double later = std::round((loop.delay - damper.delay) / damper.sampling_period);
  loop.delay = std::max(damper.delay + later * damper.sampling_period, 0.0);
  if (loop.delay == 0.0) loop.damper->delay = 0.0;
  return Device(std::move(parameters));
}

TEST(TwoRateUsersProperty, AUserHardlyAboveTheLimitDestabilises) {
  constexpr std::uint64_t seed = 20261129;
  const int devices = test::by_tier(8, 100);
  test::RandomTwoRates random(seed);
  int asked = 0;
  int reached = 0;
  for (int drawn = 0; asked < devices && drawn < 10 * devices; ++drawn) {
    const std::optional<Device> device = with_whole_delays(random.next());
    if (!device) continue;
    const std::optional<AbsoluteStabilityLimit> limit = internal::any_user_limit(*device);
    if (!limit || !(limit->stiffness > 0.0) || !std::isfinite(limit->stiffness)) continue;
    ++asked;
    if (is_reached(*device, *limit)) {
      ++reached;
    } else {
      RecordProperty(device->name(), std::to_string(limit->stiffness));
    }
  }
  EXPECT_EQ(asked, devices);
  EXPECT_GE(reached, 0.95 * asked) << "seed " << seed;
  RecordProperty("reached", reached);
}

}  // namespace
}  // namespace zwidth
