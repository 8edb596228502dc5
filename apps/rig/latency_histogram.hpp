#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "zwidth/rig/session.hpp"

namespace zwidth::rig {

/// Counts durations in ns by magnitude: 512 linear steps to each power of two, so that percentiles are within 0.2 %.
/// add() allocates, locks and throws nothing. Source: Tene, HdrHistogram.
class LatencyHistogram {
 public:
  void add(std::int64_t nanoseconds) noexcept {
    const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(nanoseconds, 0, largest));
    ++counts_[index_of(value)];
    ++count_;
    max_ = std::max(max_, value);
  }

  [[nodiscard]] double max() const noexcept { return 1e-9 * static_cast<double>(max_); }  ///< s

  [[nodiscard]] LatencySummary summary() const {
    return {count_, percentile(0.5), percentile(0.99), percentile(0.999), percentile(0.9999), max()};
  }

  /// The middle of every step that holds any.
  [[nodiscard]] std::vector<DurationCount> counts() const {
    std::vector<DurationCount> counts;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      if (counts_[i] == 0) continue;
      const auto [low, high] = ends_of(i);
      counts.push_back({0.5e-9 * static_cast<double>(low + high), counts_[i]});
    }
    return counts;
  }

 private:
  static constexpr unsigned step_bits = 10;
  static constexpr unsigned magnitudes = 28;  // to 1024 * 2^27 ns, 137 s
  static constexpr std::int64_t largest = (std::int64_t{1} << (step_bits + magnitudes - 1)) - 1;

  [[nodiscard]] static std::size_t index_of(std::uint64_t value) noexcept {
    const auto width = static_cast<unsigned>(std::bit_width(value));
    const unsigned shift = width > step_bits ? width - step_bits : 0;
    return (std::size_t{shift} << step_bits) + static_cast<std::size_t>(value >> shift);
  }

  /// The least and the largest duration of a step, ns.
  [[nodiscard]] static std::pair<std::uint64_t, std::uint64_t> ends_of(std::size_t index) noexcept {
    const std::size_t shift = index >> step_bits;
    const std::uint64_t step = index & ((1U << step_bits) - 1U);
    return {step << shift, ((step + 1U) << shift) - 1U};
  }

  /// The largest duration of the step that holds this share of all, s; 0 where there is none.
  [[nodiscard]] double percentile(double share) const {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      sum += counts_[i];
      if (sum < wanted || sum == 0) continue;
      return 1e-9 * static_cast<double>(std::min(ends_of(i).second, max_));
    }
    return 0.0;
  }

  std::array<std::uint64_t, std::size_t{magnitudes} << step_bits> counts_{};
  std::uint64_t count_ = 0;
  std::uint64_t max_ = 0;
};

}  // namespace zwidth::rig
