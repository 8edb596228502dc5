#pragma once

#include <array>

#include "zwidth/sampling/filter_section.hpp"

namespace zwidth {

/// A wall filter as it runs: a FilterSection with its past.
///
/// With w the state, u what enters and y what leaves, delta w[k] = w[k+1] - w[k]:
///
///     delta^degree w = u - d[0] w - d[1] delta w
///                  y = n[0] w + n[1] delta w + ... + n[degree] delta^degree w      n: whole_numerator()
///
/// States are differences, not past values: a filter slow against the sampling period keeps its digits.
/// u and y in the same unit (N or N m in a wall). Starts, and starts again after reset(), from w = 0.
/// Nothing allocates, locks, logs or throws. A NaN that enters never leaves: reset() it.
/// Source: Middleton & Goodwin 1986, delta operator.
class RunningFilter {
 public:
  /// Lets nothing through.
  RunningFilter() = default;
  /// At rest: every past sample is 0.
  explicit RunningFilter(const FilterSection& section) noexcept
      : degree_(section.degree), n_(whole_numerator(section)), d_(section.denominator) {}

  /// y[k] from u[k].
  [[nodiscard]] double update(double u) noexcept {
    if (degree_ == 1) {
      const double highest = u - d_[0] * w_[0];
      const double y = n_[0] * w_[0] + n_[1] * highest;
      w_[0] += highest;
      return y;
    }
    const double highest = u - d_[0] * w_[0] - d_[1] * w_[1];
    const double y = n_[0] * w_[0] + n_[1] * w_[1] + n_[2] * highest;
    w_[0] += w_[1];
    w_[1] += highest;
    return y;
  }

  /// Forgets the past.
  void reset() noexcept { w_ = {}; }

 private:
  std::size_t degree_ = 1;
  std::array<double, 3> n_{};
  std::array<double, 2> d_{};
  std::array<double, 2> w_{};
};

}  // namespace zwidth
