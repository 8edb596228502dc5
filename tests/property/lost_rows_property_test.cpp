// Recordings as a recorder wrote them: rows lost, off their time, at two rates. The whole campaign is
// benchmarks/lost_rows_campaign.cpp.
#include <gtest/gtest.h>

#include <string>

#include "campaign.hpp"
#include "property/damaged_recordings.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

TEST(LostRowsProperty, WhatIsSoundHoldsTheTruthAndStaysSound) {
  int whole_sound = 0;
  int stays_sound = 0;
  int missed = 0;
  const int count = test::by_tier(4, 12);
  int done = 0;
  for (std::uint64_t seed = 1; done < count; ++seed) {
    const auto made = test::damaged_recording(seed);
    if (!made) continue;
    ++done;
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + made->what);
    IdentifyOptions options;
    options.structure_values = IdentifyOptions::StructureValues::placeholders;
    options.scrutiny = IdentifyOptions::Scrutiny::brief;  // as the campaign
    const Device structure(made->structure);
    const std::vector<Recording> read = test::read_back(*made);
    ASSERT_EQ(read.size(), made->recorded.size());
    const Identification found = identify(read, structure, options);
    const bool is_sound = found.trust.sound();
    if (is_sound) {
      ASSERT_TRUE(found.analysis.interval);
      missed += found.analysis.interval->lower <= made->stiffness && made->stiffness <= found.analysis.interval->upper
                    ? 0
                    : 1;
      EXPECT_LE(found.analysis.interval->lower, 1.02 * made->stiffness);
    }
    if (!identify(made->whole, structure, options).trust.sound()) continue;
    ++whole_sound;
    stays_sound += is_sound ? 1 : 0;
  }
  EXPECT_GE(whole_sound, count / 2);
  EXPECT_GE(stays_sound, whole_sound - 1);
  EXPECT_LE(missed, 1);
}

}  // namespace
}  // namespace zwidth
