#include "zwidth/study/sobol_indices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

// T. Ishigami, T. Homma, ISUMA 1990, with a = 7, b = 0.1: variances in closed form.
TEST(SobolIndices, OfIshigamisFunctionAreItsOwn) {
  const double a = 7.0;
  const double b = 0.1;
  const double pi4 = std::pow(std::numbers::pi, 4);
  const double one = 0.5 * std::pow(1.0 + b * pi4 / 5.0, 2);
  const double two = a * a / 8.0;
  const double both = b * b * pi4 * pi4 * 8.0 / 225.0;
  const double whole = one + two + both;
  EXPECT_NEAR(one / whole, 0.3139, 5e-5);
  const auto ishigami = [&](const std::vector<std::vector<double>>& uniforms) {
    std::vector<double> answers;
    for (std::size_t i = 0; i < uniforms[0].size(); ++i) {
      const auto x = [&](std::size_t j) { return std::numbers::pi * (2.0 * uniforms[j][i] - 1.0); };
      answers.push_back(std::sin(x(0)) + a * std::pow(std::sin(x(1)), 2) + b * std::pow(x(2), 4) * std::sin(x(0)));
    }
    return answers;
  };
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto indices = sobol_indices(3, 1U << 13U, seed, ishigami);
    EXPECT_NEAR(indices[0].first, one / whole, 0.01) << seed;
    EXPECT_NEAR(indices[1].first, two / whole, 0.01) << seed;
    EXPECT_NEAR(indices[2].first, 0.0, 0.01) << seed;
    EXPECT_NEAR(indices[0].total, (one + both) / whole, 0.01) << seed;
    EXPECT_NEAR(indices[1].total, two / whole, 0.01) << seed;
    EXPECT_NEAR(indices[2].total, both / whole, 0.01) << seed;
  }
}

// f = sum c_j u_j: both indices are c_j^2 / sum c^2.
TEST(SobolIndices, OfASumAreItsShares) {
  const auto indices = sobol_indices(3, 1024, 5, [](const std::vector<std::vector<double>>& uniforms) {
    std::vector<double> sums;
    for (std::size_t i = 0; i < uniforms[0].size(); ++i) sums.push_back(1e6 + uniforms[0][i] + 2.0 * uniforms[2][i]);
    return sums;
  });
  EXPECT_NEAR(indices[0].first, 0.2, 0.01);
  EXPECT_NEAR(indices[0].total, 0.2, 0.01);
  EXPECT_EQ(indices[1].first, 0.0);
  EXPECT_EQ(indices[1].total, 0.0);
  EXPECT_NEAR(indices[2].total, 0.8, 0.01);
}

TEST(SobolIndices, RefuseWhatHasNoVariance) {
  const auto infinite = [](const std::vector<std::vector<double>>& uniforms) {
    return std::vector<double>(uniforms[0].size(), std::numeric_limits<double>::infinity());
  };
  EXPECT_THROW((void)sobol_indices(2, 16, 1, infinite), Error);
  EXPECT_THROW((void)sobol_indices(0, 16, 1, infinite), Error);
  const auto same = [](const std::vector<std::vector<double>>& uniforms) {
    return std::vector<double>(uniforms[0].size(), 3.0);
  };
  EXPECT_EQ(sobol_indices(2, 16, 1, same)[0].total, 0.0);
}

}  // namespace
}  // namespace zwidth
