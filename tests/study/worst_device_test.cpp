// The worst unit that a study finds, beside those of other samples; benchmarks/study_campaign does it with 10^6 of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign.hpp"
#include "study/random_studies.hpp"

namespace zwidth {
namespace {

TEST(WorstDevice, IsNoBetterThanTheWorstOfManyOthers) {
  const std::uint64_t cases = test::by_tier(2U, 6U);
  std::uint64_t beaten = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    StudyOptions options;
    options.seed = seed;
    options.samples = 2000;
    options.index_samples = options.tightening_samples = 0;
    const StudyRun run = test::random_study(seed, options);
    const Study found = study(run.device(), run.distributions(), options);
    ASSERT_TRUE(found.worst) << "seed " << seed;
    EXPECT_LE(found.worst->critical.stiffness, found.worst->sampled) << "seed " << seed;
    options.seed = 1'000'000 + seed;
    options.samples = 8 * study_chunk_size;
    const StudyRun others = test::random_study(seed, options);
    double least = std::numeric_limits<double>::infinity();
    for (std::uint64_t chunk = 0; chunk < others.chunk_count(); ++chunk) {
      for (const double stiffness : others.answers(chunk).stiffness) least = std::fmin(least, stiffness);
    }
    beaten += found.worst->critical.stiffness <= least ? 1U : 0U;
  }
  EXPECT_EQ(beaten, cases);
}

}  // namespace
}  // namespace zwidth
