#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "property/random_devices.hpp"
#include "stability/limit/gain_crossings.hpp"
#include "stability/loop/plant_fraction.hpp"
#include "stability/loop/response_bound.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::uint64_t seed = 20261126;

// What is left out of the circle holds no crossover that is asked for.
TEST(StiffnessLimit, IsThatOfAllCrossovers) {
  for (std::size_t i = 0; i < 20 * test::device_kinds.size(); ++i) {
    const std::string_view kind = test::device_kinds[i % test::device_kinds.size()];
    SCOPED_TRACE(testing::Message() << kind << ", seed " << seed + i);
    test::RandomDevices random(seed + i);
    const Device device(random.device(kind));
    const FilteredPlant plant = filtered_plant(device);
    const VirtualDamper damper = virtual_damper(device);
    const double whole = critical_stiffness(plant, damper).stiffness;
    if (!(whole > 0.0) || !std::isfinite(whole)) continue;
    for (const double share : {0.5, 1.0 - 1e-9, 1.0 + 1e-9, 2.0, 100.0, std::numeric_limits<double>::infinity()}) {
      const double least = std::min(whole, share * whole);
      EXPECT_NEAR(stiffness_limit(plant, damper, share * whole) / least, 1.0, 1e-12) << share;
    }
  }
}

TEST(StiffnessLimit, IsNothingWhereNoneIsStable) {
  std::size_t none = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    test::RandomDevices random(seed + i);
    DeviceParameters parameters = random.device("virtual_damper");
    parameters.wall.damping *= 30.0;
    const Device device(parameters);
    const double whole = critical_stiffness(filtered_plant(device), virtual_damper(device)).stiffness;
    if (whole == 0.0) ++none;
    for (const double most : {1e-3, 1.0, 1e6}) {
      EXPECT_NEAR(stiffness_limit(filtered_plant(device), virtual_damper(device), most), std::min(whole, most),
                  1e-12 * most)
          << "seed " << seed + i;
    }
  }
  EXPECT_GE(none, 50U);
}

TEST(StiffnessCrossings, UpToAStiffnessAreThoseOfAll) {
  std::size_t some = 0;
  for (std::size_t i = 0; i < 10 * test::device_kinds.size(); ++i) {
    const std::string_view kind = test::device_kinds[i % test::device_kinds.size()];
    SCOPED_TRACE(testing::Message() << kind << ", seed " << seed + i);
    test::RandomDevices random(seed + i);
    const Device device(random.device(kind));
    const FilteredPlant plant = filtered_plant(device);
    const VirtualDamper damper = virtual_damper(device);
    GainCrossings all = stiffness_crossings(plant, damper);
    if (all.crossings.empty()) continue;
    const double least = std::ranges::min(all.crossings, {}, &GainCrossing::gain).gain;
    for (const double share : {1.5, 4.0, 100.0}) {
      GainCrossings expected = all;
      std::erase_if(expected.crossings, [&](const GainCrossing& each) { return each.gain > share * least; });
      const GainCrossings found = stiffness_crossings_up_to(plant, damper, share * least);
      EXPECT_EQ(found.initially_unstable, expected.initially_unstable);
      ASSERT_EQ(found.crossings.size(), expected.crossings.size()) << share;
      for (std::size_t k = 0; k < found.crossings.size(); ++k) {
        EXPECT_NEAR(found.crossings[k].angle, expected.crossings[k].angle, 1e-12 * expected.crossings[k].angle);
        EXPECT_NEAR(found.crossings[k].gain / expected.crossings[k].gain, 1.0, 1e-10);
        EXPECT_EQ(found.crossings[k].poles_leaving, expected.crossings[k].poles_leaving);
      }
      some += found.crossings.size() < all.crossings.size() ? 1U : 0U;
    }
  }
  EXPECT_GE(some, 50U);
}

TEST(ResponseBound, IsNoLessThanTheResponseAndCloseOnNarrowIntervals) {
  for (std::size_t i = 0; i < 10 * test::device_kinds.size(); ++i) {
    const std::string_view kind = test::device_kinds[i % test::device_kinds.size()];
    SCOPED_TRACE(testing::Message() << kind << ", seed " << seed + i);
    test::RandomDevices random(seed + i);
    const FilteredPlant plant = filtered_plant(Device(random.device(kind)));
    const ResponseBound bound(plant);
    for (int k = 0; k < 20; ++k) {
      const double begin = random.log_uniform(1e-6, 3.9);
      const double end = std::min(4.0, begin * (1.0 + random.log_uniform(1e-6, 10.0)));
      const double most = bound.greatest(begin, end);
      for (int j = 0; j <= 20; ++j) {
        const double angle = std::clamp(angle_of(begin + (end - begin) * j / 20.0), 1e-9, 3.14159265358979);
        EXPECT_LE(std::abs(response(plant, angle / plant.period)), most * (1.0 + 1e-12));
      }
      double of_terms = 0.0;  // which may cancel in the sum
      const double angle = angle_of(begin);
      for (const SampledTerm& term : plant.terms) of_terms += std::abs(response(term, angle));
      of_terms *= std::abs(filter_response(plant, angle));
      const bool pairs =
          std::all_of(plant.terms.begin(), plant.terms.end(), [](const SampledTerm& term) { return term.degree <= 2; });
      if (pairs) {
        EXPECT_LE(bound.greatest(begin, begin * (1.0 + 1e-12)), of_terms * (1.0 + 1e-4));
      }
    }
  }
}

}  // namespace
}  // namespace zwidth
