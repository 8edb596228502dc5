#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "property/random_recordings.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth::test {

inline Identification identified(const RandomRecording& made) {
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  return identify(made.recording, Device(made.structure), options);
}

inline void expect_interval_holds(const Identification& found, double stiffness, std::uint64_t seed) {
  ASSERT_TRUE(found.analysis.interval) << "seed " << seed;
  EXPECT_LE(found.analysis.interval->lower, stiffness) << "seed " << seed;
  EXPECT_GE(found.analysis.interval->upper, stiffness) << "seed " << seed;
}

inline void expect_sound_and_right(const Identification& found, const RandomRecording& made) {
  EXPECT_TRUE(found.trust.sound()) << "seed " << made.seed << ": " << found.trust.reasons.front();
  expect_interval_holds(found, made.stiffness, made.seed);
}

/// The answer, and the device for any other purpose.
inline void expect_doubtful(const Identification& found, const RandomRecording& made) {
  EXPECT_FALSE(found.trust.sound()) << "seed " << made.seed;
  EXPECT_FALSE(found.analysis.trust.sound()) << "seed " << made.seed;
}

}  // namespace zwidth::test
