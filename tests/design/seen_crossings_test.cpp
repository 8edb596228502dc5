// What a grid shows of a loop bounds what isolating every crossing finds.

#include "design/region/seen_crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "design/synthesis/margin_wall.hpp"
#include "property/random_devices.hpp"
#include "stability/margins/loops_of_stiffness.hpp"

namespace zwidth::internal {
namespace {

constexpr double rounding = 1e-7;

// The plant must outlive what is returned.
SeenCrossings seen_of(const Device& device, const FilteredPlant& plant) {
  const LoopGrid grid(device, false);
  return grid.seen(plant, virtual_damper(device), LoopGrid::Response(grid.size(), 1.0));
}

TEST(SeenCrossings, AreAmongAllCrossings) {
  std::size_t falls_short = 0;
  std::size_t seen_to = 0;
  std::size_t limits = 0;
  std::size_t seen_limits = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    test::RandomDevices random(seed);
    const std::string_view kind = test::device_kinds[seed % test::device_kinds.size()];
    const Device device(random.device(kind));
    SCOPED_TRACE(testing::Message() << kind << ", seed " << seed);
    if (!device.has_bodies()) continue;
    const FilteredPlant plant = filtered_plant(device);
    const SeenCrossings seen = seen_of(device, plant);
    const LoopsOfStiffness loops(plant, virtual_damper(device));
    const double limit = critical_stiffness_of(plant, loops.crossings()).stiffness;
    if (!(limit > 0.0) || !std::isfinite(limit)) continue;
    EXPECT_GE(seen.limit(), limit * (1.0 - rounding));
    ++limits;
    seen_limits += seen.limit() <= limit * (1.0 + rounding);
    for (const double share : {0.03, 0.2, 0.5, 0.7, 0.95}) {
      const double exact = loops.slack(share * limit, 2.0, 0.5);
      if (exact == -1.0) continue;  // an unstable loop, whose margins are not asked
      EXPECT_GE(seen.slack(share * limit, 2.0, 0.5), exact - rounding) << share;
      falls_short += exact < -rounding;
      seen_to += seen.slack(share * limit, 2.0, 0.5) < -rounding;
    }
  }
  // Few are missed.
  EXPECT_GE(seen_limits, limits * 9 / 10);
  EXPECT_GE(seen_to, falls_short * 9 / 10);
  EXPECT_GT(falls_short, 100U);
}

}  // namespace
}  // namespace zwidth::internal
