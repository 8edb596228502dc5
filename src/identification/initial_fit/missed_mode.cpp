#include "identification/initial_fit/missed_mode.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

// On either side of a peak.
constexpr std::size_t least_points = 4;

/// A resonance c / (w0^2 - w^2 + j g w) in the residual.
struct Resonance {
  double frequency = 0.0;
  double damping_ratio = 0.0;
  double explained = 0.0;  ///< share of the residual's squares around it
};

struct Band {
  std::size_t begin = 0;
  std::size_t end = 0;
};

class ResidualsOfLines {
 public:
  ResidualsOfLines(const std::vector<std::complex<double>>& residuals, const std::vector<ResponsePoint>& points)
      : residuals_(residuals), points_(points) {
    // Where the noise is unknown every residual counts by its share of the response.
    for (const ResponsePoint& point : points) {
      deviations_.push_back(point.variance > 0.0 ? std::sqrt(point.variance) : 0.01 * std::abs(point.value));
    }
  }

  [[nodiscard]] double frequency(std::size_t i) const { return points_[i].frequency; }
  [[nodiscard]] double normalised(std::size_t i) const { return std::abs(residuals_[i]) / deviations_[i]; }

  /// Where w^2 |residual|, which a mode peaks in, is larger than at all points around; the largest few first.
  [[nodiscard]] std::vector<std::size_t> inertance_peaks() const {
    constexpr std::size_t few = 5;
    std::vector<double> heights;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      heights.push_back(std::abs(residuals_[i]) * frequency(i) * frequency(i));
    }
    std::vector<std::size_t> peaks;
    for (std::size_t i = least_points; i + least_points < heights.size(); ++i) {
      const auto begin = heights.begin() + static_cast<std::ptrdiff_t>(i - least_points);
      if (*std::max_element(begin, begin + static_cast<std::ptrdiff_t>(2 * least_points + 1)) == heights[i])
        peaks.push_back(i);
    }
    std::ranges::sort(peaks, std::greater{}, [&](std::size_t i) { return heights[i]; });
    peaks.resize(std::min(peaks.size(), few));
    return peaks;
  }

  /// At least `least` points on either side, and all within a share of the frequency.
  [[nodiscard]] Band around(std::size_t centre, double share, std::size_t least) const {
    Band band{centre, centre + 1};
    const auto is_near = [&](std::size_t i) {
      return std::abs(frequency(i) - frequency(centre)) <= share * frequency(centre);
    };
    while (band.begin > 0 && (centre - band.begin < least || is_near(band.begin - 1))) --band.begin;
    while (band.end < points_.size() && (band.end - centre <= least || is_near(band.end))) ++band.end;
    return band;
  }

  /// Linear least squares for w0^2, g and complex c in R (w0^2 - w^2 + j g w) = c, reweighted by the last denominator
  /// (Sanathanan and Koerner).
  [[nodiscard]] std::optional<Resonance> resonance(Band band) const {
    const auto rows = static_cast<Eigen::Index>(band.end - band.begin);
    const double unit = frequency((band.begin + band.end) / 2);
    Eigen::MatrixXd left(2 * rows, 4);
    Eigen::VectorXd right(2 * rows);
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(rows);
    Eigen::Vector4d solution;
    constexpr int iterations = 6;
    for (int iteration = 0; iteration < iterations; ++iteration) {
      for (Eigen::Index k = 0; k < rows; ++k) {
        const std::size_t i = band.begin + static_cast<std::size_t>(k);
        const double w = frequency(i) / unit;
        const double scale = weight(k) / deviations_[i];
        const std::complex<double> r = residuals_[i] * scale;
        const std::complex<double> damped = std::complex<double>(0.0, w) * r;
        left.row(2 * k) << r.real(), damped.real(), -scale, 0.0;
        left.row(2 * k + 1) << r.imag(), damped.imag(), 0.0, -scale;
        right(2 * k) = w * w * r.real();
        right(2 * k + 1) = w * w * r.imag();
      }
      solution = least_squares(left, right);
      for (Eigen::Index k = 0; k < rows; ++k) weight(k) = 1.0 / std::abs(denominator(solution, band, k, unit));
    }
    if (!(solution(0) > 0.0)) return std::nullopt;
    double left_over = 0.0;
    double all = 0.0;
    for (Eigen::Index k = 0; k < rows; ++k) {
      const std::size_t i = band.begin + static_cast<std::size_t>(k);
      const std::complex<double> fitted =
          std::complex<double>(solution(2), solution(3)) / denominator(solution, band, k, unit);
      left_over += std::norm((residuals_[i] - fitted) / deviations_[i]);
      all += std::norm(residuals_[i] / deviations_[i]);
    }
    const double w0 = std::sqrt(solution(0));
    return Resonance{w0 * unit, solution(1) / (2.0 * w0), 1.0 - left_over / all};
  }

  [[nodiscard]] std::size_t size() const { return points_.size(); }

 private:
  [[nodiscard]] std::complex<double> denominator(const Eigen::Vector4d& solution, Band band, Eigen::Index k,
                                                 double unit) const {
    const double w = frequency(band.begin + static_cast<std::size_t>(k)) / unit;
    return {solution(0) - w * w, solution(1) * w};
  }

  const std::vector<std::complex<double>>& residuals_;
  const std::vector<ResponsePoint>& points_;
  std::vector<double> deviations_;
};

/// A resonance in the residual around a point, away from the modes that the structure has.
std::optional<Resonance> mode_at(const ResidualsOfLines& residuals, std::size_t centre,
                                 const std::vector<double>& modes) {
  constexpr double share = 0.1;
  constexpr double significant = 3.0;
  constexpr double most_damping_ratio = 0.3;
  constexpr double least_explained = 0.7;
  if (residuals.normalised(centre) < significant) return std::nullopt;
  const Band band = residuals.around(centre, share, least_points);
  const auto found = residuals.resonance(band);
  if (!found || !(found->damping_ratio > 0.0 && found->damping_ratio < most_damping_ratio)) return std::nullopt;
  if (found->explained < least_explained) return std::nullopt;
  if (found->frequency < residuals.frequency(band.begin) || found->frequency > residuals.frequency(band.end - 1)) {
    return std::nullopt;
  }
  const bool is_known = std::ranges::any_of(
      modes, [&](double mode) { return std::abs(mode - found->frequency) < share * found->frequency; });
  return is_known ? std::nullopt : found;
}

std::optional<Resonance> mode_of(const ResidualsOfLines& residuals, const std::vector<double>& modes) {
  if (residuals.size() < 4 * least_points) return std::nullopt;
  for (const std::size_t centre : residuals.inertance_peaks()) {
    if (const auto found = mode_at(residuals, centre, modes)) return found;
  }
  return std::nullopt;
}

/// Middle of so many neighbouring lines, of those that stand clear of their noise, that leave most, where that is clearly more than
/// noise. Not the first and the last line, into which what lies outside the band leaks.
std::optional<double> largest_misfit(const std::vector<std::complex<double>>& residuals,
                                     const FrequencyResponse& response) {
  constexpr std::size_t many = 24;
  constexpr double clear_of_noise = 0.05;  // deviation as a share of the response
  // Of the noise, by so many lines: 1.68 times it in 150 fits that found the device; more of fewer averages.
  constexpr double few_averages = 10.0;
  constexpr double least_freedom = 4.0;
  const double freedom = std::max(least_freedom, 2.0 * response.averages - 2.0);
  const double size = response.averages > 0.0 ? std::sqrt(freedom / (freedom - 2.0)) : 1.0;
  double most = (response.averages < few_averages ? 2.0 : 1.86) * size;
  std::optional<double> middle;
  std::vector<double> frequencies;
  std::vector<double> squares;
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < response.points.size(); ++i) {
    const ResponsePoint& point = response.points[i];
    if (point.variance == 0.0) return std::nullopt;
    const double size_of_line = std::max(std::abs(point.value - residuals[i]), std::abs(point.value));
    if (std::sqrt(point.variance) > clear_of_noise * size_of_line) continue;
    frequencies.push_back(point.frequency);
    squares.push_back(std::norm(residuals[i]) / point.variance);
    sum += squares.back();
    if (squares.size() > many) sum -= squares[squares.size() - 1 - many];
    if (squares.size() < many) continue;
    const double misfit = std::sqrt(std::max(0.0, sum) / static_cast<double>(many));
    if (misfit <= most) continue;
    most = misfit;
    middle = std::sqrt(frequencies[squares.size() - many] * point.frequency);
  }
  return middle;
}

}  // namespace

std::optional<double> missed_mode(const std::vector<std::complex<double>>& residuals, const FrequencyResponse& response,
                                  const std::vector<double>& modes) {
  const auto found = mode_of(ResidualsOfLines(residuals, response.points), modes);
  return found ? std::optional(found->frequency) : largest_misfit(residuals, response);
}

}  // namespace zwidth::internal
