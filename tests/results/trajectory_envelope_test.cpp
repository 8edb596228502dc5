#include "results/trajectory_envelope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace zwidth::results {
namespace {

/// A slow swing with two narrow peaks, of a body and the force on it.
Trajectory with_peaks(std::size_t count) {
  Trajectory motion;
  motion.position.resize(1);
  motion.velocity.resize(1);
  for (std::size_t k = 0; k < count; ++k) {
    const double time = 1e-3 * static_cast<double>(k);
    motion.time.push_back(time);
    motion.measured.push_back(k == 1234 ? 7.0 : std::sin(time));
    motion.command.push_back(k == 4321 ? -9.0 : std::cos(time));
    motion.user_force.push_back(0.5 * time);
    motion.position[0].push_back(std::sin(time));
    motion.velocity[0].push_back(std::cos(time));
  }
  return motion;
}

TEST(TrajectoryEnvelope, KeepsPeaksAndWhatBelongsTogether) {
  const Trajectory all = with_peaks(10000);
  const Trajectory kept = envelope_of(all, 500);
  EXPECT_LE(kept.time.size(), 500U);
  EXPECT_GT(kept.time.size(), 100U);
  EXPECT_EQ(*std::ranges::max_element(kept.measured), 7.0);
  EXPECT_EQ(*std::ranges::min_element(kept.command), -9.0);
  EXPECT_TRUE(std::ranges::is_sorted(kept.time));
  EXPECT_EQ(kept.time.front(), 0.0);
  EXPECT_EQ(kept.time.back(), all.time.back());
  for (std::size_t i = 0; i < kept.time.size(); ++i) {
    EXPECT_EQ(kept.user_force[i], 0.5 * kept.time[i]);
    EXPECT_EQ(kept.position[0][i], std::sin(kept.time[i]));
    EXPECT_EQ(kept.velocity[0][i], std::cos(kept.time[i]));
  }
}

TEST(TrajectoryEnvelope, OfFewSamplesIsAllOfThem) {
  EXPECT_EQ(envelope_of(with_peaks(100), 100).time.size(), 100U);
  EXPECT_TRUE(envelope_of({}, 100).time.empty());
}

}  // namespace
}  // namespace zwidth::results
