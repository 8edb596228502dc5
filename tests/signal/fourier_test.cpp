#include "signal/fourier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Complex = std::complex<double>;

std::vector<Complex> random_signal(std::size_t size) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  std::vector<Complex> signal(size);
  for (Complex& value : signal) value = {normal(generator), normal(generator)};
  return signal;
}

double norm(const std::vector<Complex>& values) {
  double sum = 0.0;
  for (const Complex& value : values) sum += std::norm(value);
  return std::sqrt(sum);
}

/// The definition, in long double, with phases reduced exactly.
std::vector<Complex> by_definition(const std::vector<Complex>& signal) {
  const std::size_t n = signal.size();
  std::vector<std::complex<long double>> turn(n);
  for (std::size_t i = 0; i < n; ++i) {
    turn[i] = std::polar(
        1.0L, -2.0L * std::numbers::pi_v<long double> * static_cast<long double>(i) / static_cast<long double>(n));
  }
  std::vector<Complex> result(n);
  for (std::size_t k = 0; k < n; ++k) {
    std::complex<long double> sum;
    for (std::size_t i = 0; i < n; ++i) sum += std::complex<long double>(signal[i]) * turn[i * k % n];
    result[k] = Complex(sum);
  }
  return result;
}

class FourierLengths : public ::testing::TestWithParam<std::size_t> {};

TEST_P(FourierLengths, AgreesWithTheDefinition) {
  const std::vector<Complex> signal = random_signal(GetParam());
  const std::vector<Complex> expected = by_definition(signal);
  FourierTransform transform(signal.size());
  std::vector<Complex> actual(signal.size());
  transform.forward(signal, actual);
  std::vector<Complex> error(signal.size());
  for (std::size_t k = 0; k < signal.size(); ++k) error[k] = actual[k] - expected[k];
  EXPECT_LT(norm(error), 1e-14 * norm(expected));
}

TEST_P(FourierLengths, InverseUndoesForward) {
  const std::vector<Complex> signal = random_signal(GetParam());
  FourierTransform transform(signal.size());
  std::vector<Complex> there(signal.size());
  std::vector<Complex> back(signal.size());
  transform.forward(signal, there);
  transform.inverse(there, back);
  for (std::size_t i = 0; i < signal.size(); ++i) EXPECT_LT(std::abs(back[i] - signal[i]), 1e-13);
}

// Powers of two, small factors, a direct prime (47), Bluestein's: primes (53, 997), a multiple of one, a square of one.
INSTANTIATE_TEST_SUITE_P(Any, FourierLengths,
                         ::testing::Values(1U, 2U, 3U, 4U, 5U, 7U, 16U, 47U, 53U, 100U, 106U, 997U, 1024U, 2500U,
                                           2809U),
                         ::testing::PrintToStringParamName());

TEST(Fourier, ALargePrimeLengthKeepsItsAccuracy) {
  // Energy is preserved (Parseval) and a line stays a line, at a length where n^2 operations would take minutes.
  constexpr std::size_t size = 1000003;
  constexpr std::size_t line = 123456;
  std::vector<double> cosine(size);
  for (std::size_t i = 0; i < size; ++i) {
    cosine[i] = std::cos(2.0 * std::numbers::pi * static_cast<double>(i * line % size) / static_cast<double>(size));
  }
  const std::vector<Complex> lines = spectrum(cosine);
  ASSERT_EQ(lines.size(), size / 2 + 1);
  double rest = 0.0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (k != line) rest += std::norm(lines[k]);
  }
  EXPECT_NEAR(std::abs(lines[line]), size / 2.0, 1e-8);
  EXPECT_LT(std::sqrt(rest), 1e-13 * static_cast<double>(size));
}

TEST(Fourier, FastLengthsHaveSmallFactorsOnly) {
  EXPECT_EQ(fast_length(1), 1U);
  EXPECT_EQ(fast_length(7), 8U);
  EXPECT_EQ(fast_length(2500), 2500U);
  EXPECT_EQ(fast_length(4097), 4320U);
  EXPECT_EQ(fast_length(1000003), 1012500U);
}

TEST(Fourier, RefusesNoSamplesAndAnotherLength) {
  EXPECT_THROW(FourierTransform(0), Error);
  FourierTransform transform(8);
  std::vector<Complex> seven(7);
  std::vector<Complex> eight(8);
  EXPECT_THROW(transform.forward(seven, eight), Error);
}

}  // namespace
}  // namespace zwidth
