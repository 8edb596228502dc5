// The second route that guards every answer: it counts as eigenvalues do, decides where they cannot, and contradicts
// what is wrong.
#include "stability/second_route/pole_count.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
using namespace internal;
namespace {

int outside(const Device& device, double stiffness) {
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  int count = 0;
  const Sampling sampling{device.loop().sampling_period, device.loop().delay};
  for (const auto& delta : closed_loop_poles_minus_one(sample(state_space(device), sampling), wall)) {
    if (std::abs(1.0 + delta) > 1.0) ++count;
  }
  return count;
}

TEST(PoleCount, DoubleAndDigitsCountTheSame) {
  for (unsigned seed = 1; seed <= 84; ++seed) {
    test::RandomDevices random(seed);
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    const Device device(random.device(kind));
    const CriticalStiffness critical = critical_stiffness(filtered_plant(device), virtual_damper(device));
    if (critical.status != StiffnessStatus::finite) continue;
    const PoleCount poles(device);
    for (const double share : {0.3, 0.999, 1.001, 3.0}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " " << kind << " share " << share);
      const auto quick = poles.in_double(share * critical.stiffness);
      const auto sure = poles.in_digits(share * critical.stiffness);
      if (quick && sure) {
        EXPECT_EQ(*quick, *sure);
      }
      if (sure && (share < 1.0 || critical.stable_intervals.size() == 1)) {
        EXPECT_EQ(*sure == 0, share < 1.0) << critical.stiffness;
      }
    }
  }
}

// Beyond 40 states the winding number takes over.
TEST(PoleCount, OfLongDelaysIsThatOfEigenvalues) {
  for (const double samples : {39.5, 45.0, 60.3, 100.0}) {
    const Device device(test::with_delay(test::lhifam_parameters(), samples * 1e-3));
    const PoleCount poles(device);
    for (const double stiffness : {20.0, 70.0, 200.0, 3000.0, 40000.0}) {
      EXPECT_EQ(poles.in_double(stiffness), outside(device, stiffness)) << samples << " samples, K " << stiffness;
    }
  }
}

// A chain or a tree, with dampings of the usual size.
Device many_bodies(std::size_t bodies, bool is_tree, std::uint64_t seed) {
  test::RandomDevices random(seed);
  DeviceParameters device;
  for (std::size_t i = 0; i < bodies; ++i) {
    device.bodies.push_back(
        {"b" + std::to_string(i), random.log_uniform(0.1, 3.0), random.log_uniform(0.01, 5.0), 0.0, 0.0});
    if (i == 0) continue;
    const std::size_t nearest = is_tree && i > 4 ? i - 4 : 0;
    const std::size_t parent = is_tree ? nearest + random.index(i - nearest) : i - 1;
    device.links.push_back({parent, i, random.log_uniform(3e3, 1e6), random.log_uniform(0.1, 20.0)});
  }
  device.loop.sampling_period = 1e-3;
  device.loop.delay = 0.3e-3;
  device.loop.held = bodies - 1;
  return Device(device);
}

TEST(PoleCount, OfManyBodiesIsThatOfEigenvalues) {
  for (const std::size_t bodies : {21U, 40U}) {
    for (const bool is_tree : {false, true}) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const Device device = many_bodies(bodies, is_tree, seed);
        const double limit = critical_stiffness(filtered_plant(device)).stiffness;
        const PoleCount poles(device);
        for (const double share : {0.5, 0.999, 1.001, 2.0, 100.0}) {
          SCOPED_TRACE(testing::Message()
                       << bodies << " bodies, tree " << is_tree << ", seed " << seed << ", share " << share);
          const std::optional<int> counted = poles.in_double(share * limit);
          ASSERT_TRUE(counted.has_value());
          EXPECT_EQ(*counted, outside(device, share * limit));
          EXPECT_EQ(*counted == 0, share < 1.0);
        }
      }
    }
  }
}

// A mode that the loop neither moves nor sees stays on the circle: it is not outside.
TEST(PoleCount, AHiddenUndampedModeIsNotOutside) {
  DeviceParameters twins;
  twins.name = "twins";
  twins.bodies = {{"motor", 1.0, 2.0, 0.0, 0.0}, {"left", 0.5, 0.0, 0.0, 0.0}, {"right", 0.5, 0.0, 0.0, 0.0}};
  twins.links = {{0, 1, 4e3, 0.0}, {0, 2, 4e3, 0.0}};
  twins.loop.sampling_period = 1e-3;
  const Device device(twins);
  const PoleCount poles(device);
  const CriticalStiffness critical = critical_stiffness(filtered_plant(device));
  if (critical.status == StiffnessStatus::finite) {
    EXPECT_EQ(poles.in_digits(0.5 * critical.stiffness), 0);
    EXPECT_TRUE(critical_stiffness(device).trust.sound());
  }
}

// Issue 14, section 5: eight lags between 0.9 and 1.1 rad/s; 3294.6 was answered where 1.885 is true.
const std::vector<double> eight_lags{1.0,
                                     8.32105676757705,
                                     30.292492317337096,
                                     63.01638106302106,
                                     81.93168896436515,
                                     68.17581053664675,
                                     35.45591592994482,
                                     10.536807324628331,
                                     1.3699584802328493};

TEST(PoleCount, ContradictsAWrongCriticalStiffness) {
  const Device device(test::transfer_function_parameters({1.36913965073807}, eight_lags, 1e-3));
  const PoleCount poles(device);
  EXPECT_EQ(agreement(poles, 3294.6, true), Agreement::contradicts);
  EXPECT_EQ(agreement(poles, 1.88, true), Agreement::agrees);
  EXPECT_EQ(agreement(poles, 1.89, false), Agreement::agrees);
  const CriticalStiffness critical = critical_stiffness(device);
  if (critical.trust.refused()) {
    EXPECT_TRUE(std::isnan(critical.stiffness));
  } else {
    EXPECT_NEAR(critical.stiffness, 1.885, 1e-3);
  }
}

TEST(PoleCount, AWrongNumberIsWithdrawnWithItsReason) {
  Trust trust;
  distrust(Agreement::contradicts, 3294.6, trust);
  EXPECT_TRUE(trust.refused());
  EXPECT_NE(trust.reasons.at(0).find("contradict"), std::string::npos);
  CriticalStiffness critical;
  critical.crossovers.emplace_back();
  critical.trust = trust;
  withdraw(critical);
  EXPECT_EQ(critical.status, StiffnessStatus::refused);
  EXPECT_TRUE(std::isnan(critical.stiffness));
  EXPECT_TRUE(critical.crossovers.empty());
  EXPECT_EQ(critical.trust, trust);
}

}  // namespace
}  // namespace zwidth
