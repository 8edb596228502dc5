#include "zwidth/study/sampling_plan.hpp"

#include <algorithm>
#include <bit>
#include <boost/random/detail/sobol_table.hpp>

#include "counted.hpp"
#include "study/philox.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

// Streams of random_bits(): no two uses of a seed share numbers.
constexpr std::uint32_t numbers_stream = 0;
constexpr std::uint32_t feistel_stream = 0x10000;
constexpr std::uint32_t scramble_stream = 0x20000;

constexpr std::uint32_t feistel_rounds = 4;

/// Bratley and Fox, ACM TOMS 14, 88 (1988), section 2: m_j of a primitive polynomial, as bits below the point.
std::array<std::uint32_t, 32> direction_numbers(std::size_t dimension) {
  using Table = boost::random::detail::qrng_tables::sobol;
  std::array<std::uint32_t, 32> numbers{};
  if (dimension == 0) {
    for (std::size_t j = 0; j < 32; ++j) numbers[j] = 1U << (31 - j);
    return numbers;
  }
  const std::uint32_t polynomial = Table::polynomial(dimension - 1);
  const std::size_t degree = std::bit_width(polynomial) - 1;
  std::array<std::uint64_t, 32> m{};
  for (std::size_t j = 0; j < 32; ++j) {
    if (j < degree) {
      m[j] = Table::minit(dimension - 1, j);
    } else {
      m[j] = m[j - degree];
      for (std::size_t k = 0; k < degree; ++k) {
        if ((polynomial >> k & 1U) != 0) m[j] ^= m[j - (degree - k)] << (degree - k);
      }
    }
    numbers[j] = static_cast<std::uint32_t>(m[j] << (31 - j));
  }
  return numbers;
}

std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 1U & 0x55555555U) | (x & 0x55555555U) << 1U;
  x = (x >> 2U & 0x33333333U) | (x & 0x33333333U) << 2U;
  x = (x >> 4U & 0x0F0F0F0FU) | (x & 0x0F0F0F0FU) << 4U;
  x = (x >> 8U & 0x00FF00FFU) | (x & 0x00FF00FFU) << 8U;
  return x >> 16U | x << 16U;
}

/// Burley's nested uniform scramble: of the reversed number, every bit is changed by lower bits alone (the hash of
/// Laine and Karras).
std::uint32_t nested_scramble(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x) + seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return reversed(x);
}

}  // namespace

std::optional<OptionProblem> SamplingPlan::find_problem(SamplingScheme sampling, std::uint64_t samples,
                                                        std::size_t dimensions) {
  const std::uint64_t most = sampling == SamplingScheme::sobol ? most_sobol_samples : most_study_samples;
  if (samples < 1 || samples > most) {
    return option_problem("samples", {.code = ProblemCode::count_out_of_range,
                                      .evidence = {internal::counted("value", samples), internal::counted("least", 1),
                                                   internal::counted("most", most)}});
  }
  if (dimensions < 1 || dimensions > most_study_parameters) {
    return option_problem("parameters", {.code = ProblemCode::count_out_of_range,
                                         .evidence = {internal::counted("value", dimensions),
                                                      internal::counted("least", 1),
                                                      internal::counted("most", most_study_parameters),
                                                      {"several", 1.0}}});
  }
  return std::nullopt;
}

SamplingPlan::SamplingPlan(SamplingScheme sampling, std::uint64_t samples, std::size_t dimensions, std::uint64_t seed)
    : sampling_(sampling), samples_(samples), seed_(seed) {
  require_valid(find_problem(sampling, samples, dimensions));
  half_bits_ = std::max(1U, (static_cast<std::uint32_t>(std::bit_width(samples - 1)) + 1U) / 2U);
  if (sampling != SamplingScheme::sobol) return;
  for (std::size_t i = 0; i < dimensions; ++i) {
    directions_.push_back(direction_numbers(i));
    scrambles_.push_back(static_cast<std::uint32_t>(random_bits(seed, scramble_stream, i)));
  }
}

/// A bijection of 0..4^half_bits - 1, followed from number to number until one is below N: a bijection of those too.
std::uint64_t SamplingPlan::permuted(std::uint64_t i, std::size_t dimension) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  do {  // at most 4^half_bits < 4 N numbers lie outside of the range, so three steps are the mean at worst
    std::uint64_t left = i >> half_bits_;
    std::uint64_t right = i & mask;
    for (std::uint32_t round = 0; round < feistel_rounds; ++round) {
      const auto stream = feistel_stream + static_cast<std::uint32_t>(dimension) * feistel_rounds + round;
      const std::uint64_t mixed = left ^ (random_bits(seed_, stream, 2 * right) & mask);
      left = right;
      right = mixed;
    }
    i = left << half_bits_ | right;
  } while (i >= samples_);
  return i;
}

std::uint32_t SamplingPlan::scrambled(std::uint64_t i, std::size_t dimension) const {
  std::uint32_t point = 0;
  for (std::uint64_t bits = i; bits != 0; bits &= bits - 1) {
    point ^= directions_[dimension][static_cast<std::size_t>(std::countr_zero(bits))];
  }
  return nested_scramble(point, scrambles_[dimension]);
}

double SamplingPlan::uniform(std::uint64_t i, std::size_t dimension) const {
  const double within = uniform_of(random_bits(seed_, numbers_stream + static_cast<std::uint32_t>(dimension), i));
  switch (sampling_) {
    case SamplingScheme::random:
      return within;
    case SamplingScheme::latin_hypercube:
      return std::clamp((static_cast<double>(permuted(i, dimension)) + within) / static_cast<double>(samples_), 0x1p-53,
                        1.0 - 0x1p-53);
    case SamplingScheme::sobol:
      break;
  }
  return std::clamp((static_cast<double>(scrambled(i, dimension)) + within) * 0x1p-32, 0x1p-53, 1.0 - 0x1p-53);
}

}  // namespace zwidth
