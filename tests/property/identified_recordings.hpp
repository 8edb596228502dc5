#pragma once

#include <gtest/gtest.h>

#include "property/random_recordings.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth::test {

inline Identification identified(const RandomRecording& made,
                                 IdentifyOptions::Scrutiny scrutiny = IdentifyOptions::Scrutiny::thorough) {
  IdentifyOptions options;
  options.scrutiny = scrutiny;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  return identify(made.recording, Device(made.structure), options);
}

/// The answer, and the device for any other purpose.
inline void expect_doubtful(const Identification& found, const RandomRecording& made) {
  EXPECT_FALSE(found.trust.sound()) << "seed " << made.seed;
  EXPECT_FALSE(found.analysis.trust.sound()) << "seed " << made.seed;
}

}  // namespace zwidth::test
