#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>

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

/// Of recordings of the right structure without friction; `also` is told each answer and its recording.
template <typename Also>
void expect_sound_and_right(std::initializer_list<std::uint64_t> seeds, const Also& also) {
  for (const std::uint64_t seed : seeds) {
    const auto made = random_recording(seed);
    ASSERT_TRUE(made && made->right_structure && !made->has_friction) << "seed " << seed;
    const Identification found = identified(*made);
    ASSERT_NO_FATAL_FAILURE(expect_sound_and_right(found, *made));
    also(found, *made);
  }
}

inline void expect_sound_and_right(std::initializer_list<std::uint64_t> seeds) {
  expect_sound_and_right(seeds, [](const Identification&, const RandomRecording&) {});
}

/// The answer, and the device for any other purpose.
inline void expect_doubtful(const Identification& found, const RandomRecording& made) {
  EXPECT_FALSE(found.trust.sound()) << "seed " << made.seed;
  EXPECT_FALSE(found.analysis.trust.sound()) << "seed " << made.seed;
}

}  // namespace zwidth::test
