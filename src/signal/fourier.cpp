#include "signal/fourier.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <kissfft.hh>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

/// KissFFT takes n p operations for a prime factor p; beyond this Bluestein's three longer transforms are faster.
constexpr std::size_t largest_direct_factor = 47;

std::size_t largest_prime_factor(std::size_t number) {
  std::size_t largest = 1;
  for (std::size_t factor = 2; factor * factor <= number; ++factor) {
    while (number % factor == 0) {
      largest = factor;
      number /= factor;
    }
  }
  return std::max(largest, number);
}

/// e^{-j pi i^2 / n}; i^2 is reduced exactly, since its rounding would be that of the phase.
std::vector<Complex> chirp(std::size_t size) {
  std::vector<Complex> values(size);
  const std::uint64_t turn = 2 * static_cast<std::uint64_t>(size);
  std::uint64_t square = 0;
  for (std::size_t i = 0; i < size; ++i) {
    values[i] = std::polar(1.0, -std::numbers::pi * static_cast<double>(square) / static_cast<double>(size));
    square = (square + 2 * static_cast<std::uint64_t>(i) + 1) % turn;
  }
  return values;
}

/// A transform of any length as a convolution of a length that is fast:
/// X[k] = c[k] sum_i (x[i] c[i]) conj(c[k - i]),  c[i] = e^{-j pi i^2 / n}, as i k = (i^2 + k^2 - (k - i)^2) / 2.
class Bluestein {
 public:
  explicit Bluestein(std::size_t size)
      : chirp_(chirp(size)),
        padded_(fast_length(2 * size - 1)),
        transform_(padded_, false),
        kernel_(padded_),
        signal_(padded_),
        spectrum_(padded_) {
    for (std::size_t i = 0; i < size; ++i) {
      signal_[i] = std::conj(chirp_[i]);
      if (i > 0) signal_[padded_ - i] = signal_[i];
    }
    transform_.transform(signal_.data(), kernel_.data());
  }

  void forward(std::span<const Complex> input, std::span<Complex> output) {
    std::fill(signal_.begin(), signal_.end(), Complex{});
    for (std::size_t i = 0; i < chirp_.size(); ++i) signal_[i] = input[i] * chirp_[i];
    transform_.transform(signal_.data(), spectrum_.data());
    // The way back is a forward transform of the conjugate.
    for (std::size_t i = 0; i < padded_; ++i) spectrum_[i] = std::conj(spectrum_[i] * kernel_[i]);
    transform_.transform(spectrum_.data(), signal_.data());
    const double scale = 1.0 / static_cast<double>(padded_);
    for (std::size_t k = 0; k < chirp_.size(); ++k) output[k] = scale * std::conj(signal_[k]) * chirp_[k];
  }

 private:
  std::vector<Complex> chirp_;
  std::size_t padded_;
  kissfft<double> transform_;
  std::vector<Complex> kernel_;
  std::vector<Complex> signal_;
  std::vector<Complex> spectrum_;
};

}  // namespace

/// One of the two.
struct FourierTransform::Parts {
  std::unique_ptr<kissfft<double>> direct;
  std::unique_ptr<Bluestein> bluestein;
};

FourierTransform::FourierTransform(std::size_t size) : size_(size), parts_(std::make_unique<Parts>()) {
  if (size == 0) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::transform_of_nothing});
  if (largest_prime_factor(size) <= largest_direct_factor) {
    parts_->direct = std::make_unique<kissfft<double>>(size, false);
  } else {
    parts_->bluestein = std::make_unique<Bluestein>(size);
  }
}

FourierTransform::~FourierTransform() = default;
FourierTransform::FourierTransform(FourierTransform&&) noexcept = default;
FourierTransform& FourierTransform::operator=(FourierTransform&&) noexcept = default;

void FourierTransform::forward(std::span<const Complex> input, std::span<Complex> output) {
  if (input.size() != size_ || output.size() != size_) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::transform_of_other_length});
  }
  if (parts_->direct) {
    parts_->direct->transform(input.data(), output.data());
  } else {
    parts_->bluestein->forward(input, output);
  }
}

void FourierTransform::inverse(std::span<const Complex> input, std::span<Complex> output) {
  forward(input, output);
  std::reverse(output.begin() + 1, output.end());  // x[i] is the forward transform of X at -i, over n
  const double scale = 1.0 / static_cast<double>(size_);
  for (Complex& value : output) value *= scale;
}

std::vector<Complex> spectrum(std::span<const double> signal) {
  FourierTransform transform(signal.size());
  const std::vector<Complex> input(signal.begin(), signal.end());
  std::vector<Complex> output(signal.size());
  transform.forward(input, output);
  output.resize(signal.size() / 2 + 1);
  return output;
}

std::size_t fast_length(std::size_t size) {
  for (std::size_t length = std::max<std::size_t>(size, 1);; ++length) {
    std::size_t rest = length;
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return length;
  }
}

}  // namespace zwidth::internal
