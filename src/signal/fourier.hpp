#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace zwidth::internal {

/// The discrete Fourier transform of one length, any length, in O(n log n).
///
///     X[k] = sum_i x[i] e^{-2 pi j i k / n}
///
/// Its own memory is allocated once, by the constructor. Not to be used from two threads at once.
/// Source: KissFFT for lengths of small prime factors; Bluestein 1970 for the rest.
class FourierTransform {
 public:
  /// Requires size >= 1.
  explicit FourierTransform(std::size_t size);
  ~FourierTransform();
  FourierTransform(const FourierTransform&) = delete;
  FourierTransform& operator=(const FourierTransform&) = delete;
  FourierTransform(FourierTransform&&) noexcept;
  FourierTransform& operator=(FourierTransform&&) noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// `input` and `output` are of size() and do not overlap.
  void forward(std::span<const std::complex<double>> input, std::span<std::complex<double>> output);

  /// x[i] = (1/n) sum_k X[k] e^{+2 pi j i k / n}: undoes forward().
  void inverse(std::span<const std::complex<double>> input, std::span<std::complex<double>> output);

 private:
  struct Parts;
  std::size_t size_;
  std::unique_ptr<Parts> parts_;
};

/// X[0 .. n/2] of a real signal of any length n >= 1.
[[nodiscard]] std::vector<std::complex<double>> spectrum(std::span<const double> signal);

/// The least length >= `size` of which all prime factors are 2, 3 or 5: the fast ones. Requires size >= 1.
[[nodiscard]] std::size_t fast_length(std::size_t size);

}  // namespace zwidth::internal
