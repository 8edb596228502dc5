#include "signal/window_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace zwidth::internal {
namespace {

/// w[i] = c[0] - c[1] cos(2 pi i / L) + c[2] cos(4 pi i / L).
std::array<double, 3> cosine_coefficients(Window window) {
  switch (window) {
    case Window::hann:
      return {0.5, 0.5, 0.0};
    case Window::hamming:
      return {0.54, 0.46, 0.0};
    case Window::blackman:
      return {0.42, 0.5, 0.08};
    case Window::rectangular:
      break;
  }
  return {1.0, 0.0, 0.0};
}

/// Mean of w^2, from the coefficients.
double mean_square(const std::array<double, 3>& c) { return c[0] * c[0] + 0.5 * (c[1] * c[1] + c[2] * c[2]); }

}  // namespace

std::vector<double> window_function(Window window, std::size_t length) {
  const auto c = cosine_coefficients(window);
  std::vector<double> values(length);
  for (std::size_t i = 0; i < length; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length);
    values[i] = c[0] - c[1] * std::cos(angle) + c[2] * std::cos(2.0 * angle);
  }
  return values;
}

std::size_t main_lobe_half_width(Window window) {
  switch (window) {
    case Window::rectangular:
      return 1;
    case Window::blackman:
      return 3;
    case Window::hann:
    case Window::hamming:
      break;
  }
  return 2;
}

double lobe_second_moment(Window window) {
  const auto c = cosine_coefficients(window);
  return 0.5 * (c[1] * c[1] + 4.0 * c[2] * c[2]) / mean_square(c);
}

double independent_segments(const std::vector<double>& window, std::size_t segments, std::size_t step) {
  const std::span<const double> w(window);
  double energy = 0.0;
  for (const double value : w) energy += value * value;
  const auto count = static_cast<double>(segments);
  double sum = 1.0;
  for (std::size_t j = 1; j < segments && j * step < w.size(); ++j) {
    double product = 0.0;
    for (std::size_t i = 0; i + j * step < w.size(); ++i) product += w[i] * w[i + j * step];
    const double correlation = product / energy;
    sum += 2.0 * (1.0 - static_cast<double>(j) / count) * correlation * correlation;
  }
  return count / sum;
}

double noise_correlation(Window window, std::size_t lines_apart) {
  // Lines of w^2, a cosine series of its own, by its coefficients.
  const auto c = cosine_coefficients(window);
  const double power = mean_square(c);
  switch (lines_apart) {
    case 0:
      return 1.0;
    case 1:
      return std::abs(c[0] * c[1] + 0.5 * c[1] * c[2]) / power;
    case 2:
      return std::abs(c[0] * c[2] + 0.25 * c[1] * c[1]) / power;
    case 3:
      return std::abs(0.5 * c[1] * c[2]) / power;
    case 4:
      return 0.25 * c[2] * c[2] / power;
    default:
      return 0.0;
  }
}

double line_correlation(Window window) {
  double sum = 1.0;
  for (std::size_t k = 1; k <= 4; ++k) sum += 2.0 * noise_correlation(window, k);
  return sum;
}

}  // namespace zwidth::internal
