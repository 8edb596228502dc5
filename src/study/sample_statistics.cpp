#include "zwidth/study/sample_statistics.hpp"

#include <algorithm>
#include <bit>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <span>

#include "counted.hpp"
#include "require_argument.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

/// P(B <= k) of a binomial number: I_{1-p}(n - k, k + 1).
double binomial_probability(std::uint64_t k, std::uint64_t n, double p) {
  if (k >= n) return 1.0;
  return boost::math::ibetac(static_cast<double>(k) + 1.0, static_cast<double>(n - k), p);
}

/// The least k in 0..n with P(B <= k) >= share.
std::uint64_t binomial_quantile(double share, std::uint64_t n, double p) {
  std::uint64_t low = 0;
  std::uint64_t high = n;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (binomial_probability(middle, n, p) >= share) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

constexpr unsigned digit_bits = 16;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

/// A whole number that rises as the double does; NaN first of all.
std::uint64_t key_of(double value) {
  if (std::isnan(value)) return 0;
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 is 0
  constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

double value_of(std::uint64_t key) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
  if (key == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::bit_cast<double>((key & sign) != 0 ? key & ~sign : ~key);
}

}  // namespace

Proportion proportion(std::uint64_t count, std::uint64_t total, double confidence) {
  internal::require_fraction({"confidence", confidence});
  if (total == 0 || count > total) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::count_no_share,
                 .evidence = {internal::counted("count", count), internal::counted("total", total)}});
  }
  const double tail = 0.5 * (1.0 - confidence);
  const auto k = static_cast<double>(count);
  const auto n = static_cast<double>(total);
  Proportion share{count, total, k / n, 0.0, 1.0};
  if (count > 0) share.lower = boost::math::ibeta_inv(k, n - k + 1.0, tail);
  if (count < total) share.upper = boost::math::ibetac_inv(k + 1.0, n - k, tail);
  return share;
}

StatisticInterval weighted_sum_interval(double sum, double squares, double largest, double confidence) {
  internal::require_fraction({"confidence", confidence});
  if (!(largest > 0.0 && largest <= sum && squares > 0.0 && std::isfinite(sum) && std::isfinite(squares))) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::weights_not_possible,
                                              .evidence = {{"sum", sum}, {"squares", squares}, {"largest", largest}}});
  }
  const auto quantile = [](double mean, double variance, double share) {
    return variance / mean * boost::math::gamma_p_inv(mean / variance * mean, share);
  };
  const double tail = 0.5 * (1.0 - confidence);
  return {quantile(sum, squares, tail), quantile(sum + largest, squares + largest * largest, 1.0 - tail)};
}

QuantileRanks quantile_ranks(double p, std::uint64_t samples, double confidence) {
  internal::require_fraction({"p", p});
  internal::require_fraction({"confidence", confidence});
  const double tail = 0.5 * (1.0 - confidence);
  QuantileRanks ranks;
  // P(B <= lower - 1) <= tail, lower as large as can be; P(B <= upper - 1) >= 1 - tail, upper as small as can be.
  std::uint64_t lower = binomial_quantile(tail, samples, p);
  if (binomial_probability(lower, samples, p) <= tail) ++lower;
  if (lower >= 1) ranks.lower = lower;
  const std::uint64_t upper = binomial_quantile(1.0 - tail, samples, p) + 1;
  if (upper <= samples) ranks.upper = upper;
  return ranks;
}

std::optional<std::uint64_t> tolerance_rank(double coverage, double confidence, std::uint64_t samples) {
  internal::require_fraction({"coverage", coverage});
  internal::require_fraction({"confidence", confidence});
  std::uint64_t rank = binomial_quantile(1.0 - confidence, samples, 1.0 - coverage);
  if (binomial_probability(rank, samples, 1.0 - coverage) <= 1.0 - confidence) ++rank;
  return rank >= 1 ? std::optional(rank) : std::nullopt;
}

std::uint64_t wilks_samples(double coverage, double confidence) {
  internal::require_fraction({"coverage", coverage});
  internal::require_fraction({"confidence", confidence});
  return static_cast<std::uint64_t>(std::ceil(std::log1p(-confidence) / std::log(coverage)));
}

std::vector<double> order_statistics(const std::vector<std::uint64_t>& ranks, const NumberPass& pass) {
  struct Search {
    std::uint64_t prefix = 0;
    std::uint64_t rest = 0;  // of the rank, from 0, among the numbers with this prefix
  };
  std::vector<Search> searches;
  searches.reserve(ranks.size());
  for (const std::uint64_t rank : ranks) searches.push_back({0, rank - 1});
  for (unsigned shift = 64 - digit_bits;; shift -= digit_bits) {
    std::vector<std::uint64_t> prefixes;
    prefixes.reserve(searches.size());
    for (const Search& each : searches) prefixes.push_back(each.prefix);
    std::ranges::sort(prefixes);
    prefixes.erase(std::unique(prefixes.begin(), prefixes.end()), prefixes.end());
    std::vector<std::uint64_t> counts(prefixes.size() * digits, 0);
    const bool is_first = shift == 64 - digit_bits;
    pass([&](double value) {
      const std::uint64_t key = key_of(value);
      const std::uint64_t prefix = is_first ? 0 : key >> (shift + digit_bits);
      const auto found = std::ranges::lower_bound(prefixes, prefix);
      if (found == prefixes.end() || *found != prefix) return;
      ++counts[static_cast<std::size_t>(found - prefixes.begin()) * digits + (key >> shift & (digits - 1))];
    });
    for (Search& each : searches) {
      const auto place = static_cast<std::size_t>(std::ranges::lower_bound(prefixes, each.prefix) - prefixes.begin());
      const std::span<const std::uint64_t> of_prefix(counts.data() + place * digits, digits);
      std::uint64_t digit = 0;
      while (digit + 1 < digits && each.rest >= of_prefix[digit]) each.rest -= of_prefix[digit++];
      each.prefix = each.prefix << digit_bits | digit;
    }
    if (shift == 0) break;
  }
  std::vector<double> values;
  values.reserve(searches.size());
  for (const Search& each : searches) values.push_back(value_of(each.prefix));
  return values;
}

}  // namespace zwidth
