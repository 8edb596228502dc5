// Random devices with crowded poles against Schur and Cohn's count of the closed loop's poles in 200-digit arithmetic,
// which seeks no roots, knows of no terms and shares nothing with the library.

#include <gtest/gtest.h>

#include <algorithm>

#include "exact_closed_loop.hpp"
#include "property/property_cases.hpp"
#include "property/random_devices.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

// A count takes milliseconds, of long chains tenths of a second.
std::size_t cases_per_kind() { return std::max<std::size_t>(2, test::property_cases(10'000) / 2000); }

class CrowdedPolesProperty : public testing::TestWithParam<std::string_view> {};

// K_CR to 1e-7, stability everywhere below it, and every crossover to 1e-6 with the poles that it claims.
TEST_P(CrowdedPolesProperty, CountsInManyDigitsConfirmEveryCrossover) {
  constexpr double step_at_limit = 1e-7;
  // Beyond 1e8 times K_CR the terms cancel so far that a crossover's K keeps four digits (docs/completeness.md: where the arithmetic ends).
  const auto step_of = [](const Crossover& crossover, double limit) {
    return crossover.stiffness > 1e8 * limit ? 1e-4 : 1e-6;
  };
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    test::RandomDevices random(seed * 1000003 + 29);
    const Device device(random.crowded_device(GetParam()));
    const CriticalStiffness result = critical_stiffness(filtered_plant(device));
    const test::ExactClosedLoop loop(device);
    ASSERT_EQ(result.status, StiffnessStatus::finite) << GetParam() << " seed " << seed;
    for (const double share : {1.0 - step_at_limit, 0.9, 0.5, 0.1, 1e-2, 1e-4}) {
      ASSERT_EQ(loop.poles_outside(share * result.stiffness), 0) << GetParam() << " seed " << seed << " x " << share;
    }
    ASSERT_GT(loop.poles_outside((1.0 + step_at_limit) * result.stiffness), 0) << GetParam() << " seed " << seed;

    std::vector<Crossover> by_stiffness = result.crossovers;
    std::sort(by_stiffness.begin(), by_stiffness.end(),
              [](const Crossover& a, const Crossover& b) { return a.stiffness < b.stiffness; });
    // Far stiffer ones are where the response is rounding of its terms.
    std::erase_if(by_stiffness, [&](const Crossover& c) { return c.stiffness > 1e12 * result.stiffness; });
    int before = 0;
    for (std::size_t i = 0; i < by_stiffness.size(); ++i) {
      const auto crowds = [&](std::size_t a, std::size_t b) {
        return by_stiffness[b].stiffness <
               by_stiffness[a].stiffness * (1.0 + 3.0 * step_of(by_stiffness[b], result.stiffness));
      };
      if ((i > 0 && crowds(i - 1, i)) || (i + 1 < by_stiffness.size() && crowds(i, i + 1))) {
        before = -1;
        continue;
      }
      const Crossover& crossover = by_stiffness[i];
      const double step = step_of(crossover, result.stiffness);
      const int below = loop.poles_outside((1.0 - step) * crossover.stiffness);
      const int above = loop.poles_outside((1.0 + step) * crossover.stiffness);
      ASSERT_EQ(above - below, crossover.poles_leaving)
          << GetParam() << " seed " << seed << " K = " << crossover.stiffness;
      if (before >= 0) {
        ASSERT_EQ(below, before) << GetParam() << " seed " << seed << ": missed below K = " << crossover.stiffness;
      }
      before = above;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CrowdedPolesProperty, testing::ValuesIn(test::crowded_kinds),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace zwidth
