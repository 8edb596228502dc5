#include "zwidth/study/sampling_plan.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "study/philox.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

// Random123 1.14, kat_vectors, the three lines "philox4x32 10".
TEST(Philox, GivesThePublishedAnswers) {
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(internal::philox({0, 0, 0, 0}, {0, 0}), (Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(internal::philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(internal::philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(SamplingPlan, EveryNumberIsInsideAndDependsOnItsOwnIndexAlone) {
  for (const SamplingScheme sampling :
       {SamplingScheme::random, SamplingScheme::latin_hypercube, SamplingScheme::sobol}) {
    const SamplingPlan plan(sampling, 1000, 3, 7);
    const SamplingPlan again(sampling, 1000, 3, 7);
    const SamplingPlan other(sampling, 1000, 3, 8);
    int equal = 0;
    for (std::uint64_t i = 1000; i-- > 0;) {
      for (std::size_t j = 0; j < 3; ++j) {
        const double u = plan.uniform(i, j);
        ASSERT_GE(u, 0x1p-53);
        ASSERT_LE(u, 1.0 - 0x1p-53);
        ASSERT_EQ(u, again.uniform(i, j));
        equal += u == other.uniform(i, j) ? 1 : 0;
      }
    }
    EXPECT_EQ(equal, 0);
  }
}

// Each of N shares once, for sizes that are powers of two, just beyond, and small.
TEST(SamplingPlan, ALatinHypercubeFillsEveryShareOnce) {
  for (const std::uint64_t samples : {1U, 2U, 3U, 64U, 65U, 1000U, 1025U}) {
    const SamplingPlan plan(SamplingScheme::latin_hypercube, samples, 4, 11);
    for (std::size_t j = 0; j < 4; ++j) {
      std::set<std::uint64_t> shares;
      for (std::uint64_t i = 0; i < samples; ++i) {
        shares.insert(static_cast<std::uint64_t>(std::floor(plan.uniform(i, j) * static_cast<double>(samples))));
      }
      EXPECT_EQ(shares.size(), samples) << samples << " " << j;
    }
  }
}

// The scramble keeps what makes them a net: in every dimension each of 2^m shares holds one of 2^m points, and in the
// first two dimensions every elementary box of area 2^-m does: they are a (0, m, 2)-net.
TEST(SamplingPlan, ScrambledSobolPointsAreANet) {
  constexpr std::uint32_t m = 8;
  constexpr std::uint64_t count = 1U << m;
  const SamplingPlan plan(SamplingScheme::sobol, count, 6, 3);
  for (std::size_t j = 0; j < 6; ++j) {
    std::set<int> shares;
    for (std::uint64_t i = 0; i < count; ++i) shares.insert(static_cast<int>(plan.uniform(i, j) * count));
    EXPECT_EQ(shares.size(), count) << j;
  }
  for (std::uint32_t split = 0; split <= m; ++split) {
    std::set<std::pair<int, int>> boxes;
    for (std::uint64_t i = 0; i < count; ++i) {
      boxes.emplace(static_cast<int>(plan.uniform(i, 0) * (1U << split)),
                    static_cast<int>(plan.uniform(i, 1) * (1U << (m - split))));
    }
    EXPECT_EQ(boxes.size(), count) << split;
  }
}

// Integral of the product of 1 + (|4u - 2| - 1)/2 over the cube is 1; Owen's scramble gains orders over random points.
TEST(SamplingPlan, SobolPointsIntegrateBetterThanRandomOnes) {
  const auto error = [](SamplingScheme sampling) {
    double square = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const SamplingPlan plan(sampling, 1024, 5, seed);
      double sum = 0.0;
      for (std::uint64_t i = 0; i < 1024; ++i) {
        double product = 1.0;
        for (std::size_t j = 0; j < 5; ++j) product *= 1.0 + 0.5 * (std::abs(4.0 * plan.uniform(i, j) - 2.0) - 1.0);
        sum += product;
      }
      square += std::pow(sum / 1024.0 - 1.0, 2);
    }
    return std::sqrt(square / 20.0);
  };
  EXPECT_LT(error(SamplingScheme::sobol), 0.1 * error(SamplingScheme::random));
  EXPECT_LT(error(SamplingScheme::latin_hypercube), 0.5 * error(SamplingScheme::random));
}

TEST(SamplingPlan, RefusesWhatItCannotNumber) {
  EXPECT_THROW(SamplingPlan(SamplingScheme::random, 0, 1, 1), Error);
  EXPECT_THROW(SamplingPlan(SamplingScheme::sobol, most_sobol_samples + 1, 1, 1), Error);
  EXPECT_THROW(SamplingPlan(SamplingScheme::random, 10, most_study_parameters + 1, 1), Error);
}

}  // namespace
}  // namespace zwidth
