// The records of the identification campaign are those of the devices whose limit they are judged by.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "identification/campaign/kinds.hpp"
#include "identification/campaign/recording.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::test::campaign {
namespace {

Case case_of(const char* name, std::uint64_t seed) { return drawn_case(*find_kind(name), seed); }

TEST(CampaignKinds, AreAtLeastFortyAndEachIsDrawn) {
  std::set<std::string> names;
  for (const Kind& kind : kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    for (const std::uint64_t seed : {1U, 2U}) {
      const Case made = drawn_case(kind, seed);
      EXPECT_GT(made.stiffness, 0.0) << kind.name;
      EXPECT_GT(made.experiment.force, 0.0) << kind.name;
      EXPECT_LT(made.experiment.lowest_hz, made.experiment.highest_hz) << kind.name;
      EXPECT_LT(made.experiment.highest_hz, 0.5 / made.experiment.period) << kind.name;
      EXPECT_LE(made.plant.masses.size(), simulated::most_masses) << kind.name;
      EXPECT_EQ(find_problem(made.structure), std::nullopt) << kind.name;
      if (made.free.empty()) continue;
      EXPECT_EQ(free_parameters(Device(made.structure), made.free, made.locked).size(), made.free.size()) << kind.name;
    }
  }
  EXPECT_GE(names.size(), 40U);
}

/// Without noise the record of a linear kind is the sampled motion of its true device, to the encoder's step.
TEST(CampaignKinds, ALinearRecordIsThatOfItsTrueDevice) {
  for (const char* name : {"rigid_chirp", "two_body_multisine", "handle_sensed", "three_body", "delay_and_lag",
                           "spring_named", "mode_in_band", "coil_back_emf", "viscoelastic_link"}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      Case made = case_of(name, seed);
      made.experiment.noise = 0.0;
      made.experiment.disturbance = 0.0;
      const Recording recording = recorded(made).front().recording;
      const auto& position = recording.channels[1].samples;
      const std::vector<double> exact =
          forced_response(sample(state_space(Device(made.truth)), {made.experiment.period, made.truth.loop.delay}),
                          recording.channels[0].samples);
      ASSERT_EQ(exact.size(), position.size());
      double largest = 0.0;
      for (const double each : exact) largest = std::max(largest, std::abs(each));
      for (std::size_t k = 0; k < exact.size(); ++k) {
        // Rounded after an offset of less than a step.
        ASSERT_GT(position[k] - exact[k], -0.51 * made.experiment.resolution - 1e-5 * largest)
            << name << seed << " " << k;
        ASSERT_LT(position[k] - exact[k], 1.51 * made.experiment.resolution + 1e-5 * largest)
            << name << seed << " " << k;
      }
    }
  }
}

TEST(CampaignKinds, ARecordIsThatOfItsSeeds) {
  const Case made = case_of("friction_1_to_5_twice", 4);
  const auto first = recorded(made, 1);
  const auto same = recorded(case_of("friction_1_to_5_twice", 4), 1);
  const auto other = recorded(made, 2);
  ASSERT_EQ(first.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t channel = 0; channel < 2; ++channel) {
      EXPECT_EQ(first[i].recording.channels[channel].samples, same[i].recording.channels[channel].samples);
    }
    EXPECT_EQ(first[i].recording.channels[0].samples, other[i].recording.channels[0].samples);
    EXPECT_NE(first[i].recording.channels[1].samples, other[i].recording.channels[1].samples);
  }
}

TEST(CampaignKinds, LostRowsKeepTheirTimes) {
  const Case made = case_of("lost_rows", 1);
  const Rows rows = recorded(made).front();
  ASSERT_EQ(rows.times.size(), rows.recording.channels[0].samples.size());
  const double whole = made.experiment.duration / made.experiment.period;
  EXPECT_LT(static_cast<double>(rows.times.size()), whole);
  EXPECT_TRUE(std::ranges::is_sorted(rows.times));
}

}  // namespace
}  // namespace zwidth::test::campaign
