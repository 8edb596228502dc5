#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "identification/verdict/left_over.hpp"

namespace zwidth::internal {

/// One test of what the best fit leaves.
struct Omnibus {
  enum class Kind : std::uint8_t {
    correlated,        ///< with itself: portmanteau (Ljung & Box 1978)
    follows_force,     ///< with the force at lags: linear motion that the structure lacks
    nonlinear,         ///< with what nonlinear forces would add
    varies_with_speed  ///< its variance with the speed
  };
  struct Part {
    Kind kind = Kind::correlated;
    double statistic = 0.0;  ///< of chi squared
    int freedom = 0;         ///< degrees
    double p = 1.0;          ///< of as much or more by chance
  };
  double p = 1.0;       ///< of all: Cauchy combination (Liu & Xie 2020), valid however they hang together
  double excess = 0.0;  ///< largest (statistic - freedom) / sqrt(2 freedom)
  Kind clearest = Kind::correlated;
  std::size_t record = 0;  ///< where the clearest stands out most, of tenths of each segment
  std::size_t first = 0;   ///< sample
  std::size_t count = 0;   ///< samples
  std::vector<Part> parts = {};
};

/// Residuals and candidates are freed of all fitted directions first; the covariance of scores is consistent under changing
/// variance and correlation (Newey & West 1987), samples of a repeated force at one phase being one: rounding repeats with it.
[[nodiscard]] Omnibus omnibus(const std::vector<LeftOver>& left);

}  // namespace zwidth::internal
