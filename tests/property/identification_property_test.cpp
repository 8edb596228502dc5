// Simulated recordings whose truth is known: an answer that is called sound is on the safe side of it. The whole
// campaign is benchmarks/identification_campaign.cpp; its seeds that were answered wrongly:
// identification_seeds_property_test.cpp.
#include <gtest/gtest.h>

#include <string>

#include "campaign.hpp"
#include "property/random_recordings.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

TEST(IdentificationProperty, WhatIsCalledSoundIsSafe) {
  int sound = 0;
  int unsafe = 0;
  constexpr std::uint64_t first = 1000;
  const std::uint64_t count = test::by_tier(8U, 24U);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const auto made = test::random_recording(seed);
    if (!made || made->truth.bodies.size() > 2) continue;  // three bodies take longer than a test should
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + made->what);
    try {
      IdentifyOptions options;
      options.structure_values = IdentifyOptions::StructureValues::placeholders;
      options.scrutiny = test::by_tier(IdentifyOptions::Scrutiny::brief, IdentifyOptions::Scrutiny::thorough);
      const Identification found = identify(made->recording, Device(made->structure), options);
      if (!found.trust.sound()) continue;
      ++sound;
      // A mode far above the band leaves no trace in it; where it leaves one, the structure is not sound.
      EXPECT_TRUE(made->right_structure || found.fit.misfit.value_or(1.0) <= 2.0);
      ASSERT_TRUE(found.analysis.interval);
      EXPECT_LE(found.analysis.interval->lower, 1.1 * made->stiffness);
      if (found.analysis.interval->lower > made->stiffness) ++unsafe;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()), "") << "an error says why";
    }
  }
  EXPECT_GE(sound, static_cast<int>(count / 6));
  // Of some 10 answers 2.5 % are less than one; two are what chance leaves.
  EXPECT_LE(unsafe, 2);
}

}  // namespace
}  // namespace zwidth
