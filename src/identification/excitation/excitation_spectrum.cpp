#include "identification/excitation/excitation_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "counted.hpp"
#include "signal/fourier.hpp"
#include "zwidth/identification/excitation.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

/// Lines k of a transform, first <= k <= last.
struct Lines {
  std::size_t first = 0;
  std::size_t last = 0;
  [[nodiscard]] std::size_t count() const { return last - first + 1; }
};

/// Empty (last < first) where the band holds none.
Lines lines_in(RelativeBand band, std::size_t size) {
  const auto n = static_cast<double>(size);
  // A band's end that is a line but for rounding counts as that line.
  constexpr double rounding = 1e-9;
  const double first = std::max(1.0, std::ceil(band.lowest * n * (1.0 - rounding)));
  // At Nyquist a line has no phase of its own.
  const double last = std::min(std::floor(band.highest * n * (1.0 + rounding)), std::ceil(0.5 * n) - 1.0);
  return {static_cast<std::size_t>(first), static_cast<std::size_t>(std::max(last, 0.0))};
}

/// The signal whose lines in the band are these, up to a factor: Re sum_k line_k e^{2 pi j i k / size}.
std::vector<double> signal_of(const std::vector<Complex>& lines, std::size_t first, std::size_t size) {
  std::vector<Complex> all(size);
  std::copy(lines.begin(), lines.end(), all.begin() + static_cast<std::ptrdiff_t>(first));
  std::vector<Complex> turned(size);
  FourierTransform(size).inverse(all, turned);
  std::vector<double> signal(size);
  std::transform(turned.begin(), turned.end(), signal.begin(), [](const Complex& value) { return value.real(); });
  return signal;
}

}  // namespace

std::optional<OptionProblem> find_problem(std::size_t size, RelativeBand band) {
  if (static_cast<double>(size) > max_transformed_samples) {
    return option_problem("duration", {.code = ProblemCode::transform_too_long,
                                       .evidence = {counted("samples", size), {"most", max_transformed_samples}}});
  }
  const Lines lines = lines_in(band, size);
  if (lines.first <= lines.last) return std::nullopt;
  return option_problem("highest_hz", {.code = ProblemCode::band_without_line});
}

std::vector<double> schroeder_multisine(std::size_t size, RelativeBand band) {
  const Lines lines = lines_in(band, size);
  const auto n = static_cast<double>(lines.count());
  std::vector<Complex> values(lines.count());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto k = static_cast<double>(i);
    // -i (i - 1) pi / n for i from 1; in half turns modulo 2, exact before it is multiplied.
    const double half_turns = std::fmod(k * (k + 1.0), 2.0 * n) / n;
    values[i] = std::polar(1.0, -std::numbers::pi * half_turns);
  }
  return signal_of(values, lines.first, size);
}

std::vector<double> band_limited_noise(std::size_t size, RelativeBand band, std::uint64_t seed) {
  const Lines lines = lines_in(band, size);
  std::mt19937_64 generator(seed);
  // Of our own: the standard's distributions differ between libraries. 53 bits, in (0, 1].
  const auto uniform = [&] { return std::ldexp(static_cast<double>((generator() >> 11) + 1), -53); };
  std::vector<Complex> values(lines.count());
  for (Complex& value : values) {
    const double magnitude = std::sqrt(-2.0 * std::log(uniform()));  // Box and Muller: a complex normal variate
    value = std::polar(magnitude, 2.0 * std::numbers::pi * uniform());
  }
  return signal_of(values, lines.first, size);
}

}  // namespace zwidth::internal
