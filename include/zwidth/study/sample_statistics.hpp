#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace zwidth {

/// A share that was counted, with an interval that holds the true one.
struct Proportion {
  std::uint64_t count = 0;  ///< of those that have it
  std::uint64_t total = 0;  ///< of all
  double value = 0.0;       ///< count / total
  double lower = 0.0;       ///< of its 95 % interval
  double upper = 1.0;       ///< of its 95 % interval
};

/// The share with Clopper and Pearson's interval, which holds the true one at least as often as `confidence` says:
///
///     I_lower(k, n - k + 1) = (1 - confidence)/2 = 1 - I_upper(k + 1, n - k)
///
/// Requires count <= total, total > 0, 0 < confidence < 1; throws Error (invalid_argument).
/// Source: C. J. Clopper, E. S. Pearson, Biometrika 26, 404 (1934).
[[nodiscard]] Proportion proportion(std::uint64_t count, std::uint64_t total, double confidence = 0.95);

/// An interval of a number.
struct StatisticInterval {
  double lower = 0.0;  ///< not above the true one, so often as its confidence says
  double upper = 0.0;  ///< not below it
};

/// Interval of the expectation of a sum of weights, each of something seen at random, from their `sum`, the sum of
/// their `squares` and the `largest`. With P^-1(a, p) the quantile of the gamma distribution of shape a,
///
///     lower = squares/sum P^-1(sum²/squares, (1 - confidence)/2)
///     upper = v/s P^-1(s²/v, (1 + confidence)/2),    s = sum + largest, v = squares + largest²
///
/// Equal weights make it the exact interval of a Poisson number. Others make it approximate: with 40 log-normal weights
/// (exp(z), about 15 effective ones) the upper end is too low in 138 of 4000 trials, where 100 are allowed.
/// Requires 0 < largest <= sum, squares > 0, 0 < confidence < 1; throws Error (invalid_argument).
/// Source: M. P. Fay, E. J. Feuer, Statist. Med. 16, 791 (1997).
[[nodiscard]] StatisticInterval weighted_sum_interval(double sum, double squares, double largest,
                                                      double confidence = 0.95);

/// Ranks, from 1, between which a quantile lies; absent where no sample is far enough out.
struct QuantileRanks {
  std::optional<std::uint64_t> lower;  ///< rank from 0; absent where the sample is too small for one
  std::optional<std::uint64_t> upper;  ///< rank from 0; absent where the sample is too small for one
};

/// X_(lower) <= x_p <= X_(upper) with that confidence at least, half of the rest on each side, whatever the
/// distribution: the number of samples up to x_p is binomial. Source: H. A. David, H. N. Nagaraja, Order Statistics,
/// 2003, section 7.1.
[[nodiscard]] QuantileRanks quantile_ranks(double p, std::uint64_t samples, double confidence = 0.95);

/// The rank of the sample that a share `coverage` of all exceed, with `confidence`; absent where there are too few.
/// Source: S. S. Wilks, Ann. Math. Stat. 12, 91 (1941).
[[nodiscard]] std::optional<std::uint64_t> tolerance_rank(double coverage, double confidence, std::uint64_t samples);

/// The least number of samples whose smallest is such a bound: 59 for 0.95, 0.95.
[[nodiscard]] std::uint64_t wilks_samples(double coverage, double confidence);

/// Calls its argument with every number of a column, always in the same order.
using NumberPass = std::function<void(const std::function<void(double)>&)>;

/// The numbers of these ranks (from 1) in rising order; NaN counts as the least. Four passes, in memory that does not
/// depend on how many numbers there are. Requires that ranks are at most that many.
[[nodiscard]] std::vector<double> order_statistics(const std::vector<std::uint64_t>& ranks, const NumberPass& pass);

}  // namespace zwidth
