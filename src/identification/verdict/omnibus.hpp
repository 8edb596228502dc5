#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "identification/verdict/segment_residuals.hpp"

namespace zwidth::internal {

/// One test of what the best fit leaves.
struct Omnibus {
  enum class Kind : std::uint8_t {
    follows_force,   ///< with the force at lags: linear motion that the structure lacks
    nonlinear,       ///< with what nonlinear forces would add
    records_differ,  ///< with other numbers of the device in each record
  };
  struct Part {
    Kind kind = Kind::follows_force;
    double statistic = 0.0;  ///< of chi squared
    int freedom = 0;         ///< degrees
    double p = 1.0;          ///< of as much or more by chance
  };
  double p = 1.0;       ///< of all: Cauchy combination (Liu & Xie 2020), valid however they hang together
  double excess = 0.0;  ///< largest (statistic - freedom) / sqrt(2 freedom)
  Kind clearest = Kind::follows_force;
  std::size_t record = 0;  ///< where the clearest stands out most, of tenths of each segment
  std::size_t first = 0;   ///< sample
  std::size_t count = 0;   ///< samples
  std::vector<Part> parts = {};
};

/// Residuals and candidates are freed of all fitted directions first. Their products are summed over the lines of their spectra,
/// which are independent whatever the noise's colour: what the fit's filter left of it counts for nothing.
[[nodiscard]] Omnibus omnibus(const std::vector<SegmentResiduals>& segments);

}  // namespace zwidth::internal
