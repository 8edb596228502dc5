#include "identification/residual_checks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "linear_systems.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

// A model error below this share of the response is not worth a remark.
constexpr double notable_model_error = 0.02;

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

class Residuals {
 public:
  Residuals(const std::vector<std::complex<double>>& residuals, const std::vector<ResponsePoint>& points)
      : residuals_(residuals), points_(points) {
    // Where the noise is unknown every residual counts by its share of the response.
    for (const ResponsePoint& point : points) {
      deviations_.push_back(point.variance > 0.0 ? std::sqrt(point.variance) : 0.01 * std::abs(point.value));
    }
  }

  [[nodiscard]] double frequency(std::size_t i) const { return points_[i].frequency; }
  [[nodiscard]] double normalised(std::size_t i) const { return std::abs(residuals_[i]) / deviations_[i]; }
  [[nodiscard]] double relative(std::size_t i) const { return std::abs(residuals_[i]) / std::abs(points_[i].value); }

  /// The point whose residual, with its neighbours', stands out most as a share of the response.
  [[nodiscard]] std::size_t peak() const {
    std::size_t best = 0;
    double highest = -1.0;
    for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
      const double height = std::min({relative(i - 1), relative(i), relative(i + 1)});
      if (height > highest) {
        highest = height;
        best = i;
      }
    }
    return best;
  }

  /// Where w^2 |residual|, which a missing mode peaks in, is larger than at all points around; the largest few first.
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
std::optional<Resonance> missing_mode_at(const Residuals& residuals, std::size_t centre,
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

std::optional<Resonance> missing_mode(const Residuals& residuals, const std::vector<double>& modes) {
  if (residuals.size() < 4 * least_points) return std::nullopt;
  for (const std::size_t centre : residuals.inertance_peaks()) {
    if (const auto found = missing_mode_at(residuals, centre, modes)) return found;
  }
  return std::nullopt;
}

/// Where the residuals are largest as a share of the response: the points around the peak that exceed the average.
Remark largest_model_error(const Residuals& residuals, double model_error) {
  const std::size_t centre = residuals.peak();
  Band band{centre, centre + 1};
  while (band.begin > 0 && residuals.relative(band.begin - 1) > model_error) --band.begin;
  while (band.end < residuals.size() && residuals.relative(band.end) > model_error) ++band.end;
  const double from = hertz(residuals.frequency(band.begin));
  const double to = hertz(residuals.frequency(band.end - 1));
  Finding found{.code = FindingCode::residual_largest,
                .evidence = {{"unexplained", model_error}, {"threshold", notable_model_error}, {"from", from}}};
  if (band.end - band.begin > 1) found.evidence.push_back({"to", to});
  return warning(std::move(found));
}

}  // namespace

std::optional<double> missing_mode(const std::vector<std::complex<double>>& residuals,
                                   const std::vector<ResponsePoint>& points, const std::vector<double>& modes) {
  const auto found = missing_mode(Residuals(residuals, points), modes);
  if (!found) return std::nullopt;
  return found->frequency;
}

ResidualChecks check_residuals(const ParameterFit& fit, const std::vector<ResponsePoint>& points,
                               const std::vector<double>& modes) {
  ResidualChecks checks;
  std::vector<Remark>& remarks = checks.remarks;
  if (points.size() < 3 || fit.model_error < 1e-6) return checks;
  const Residuals residuals(fit.residuals, points);
  if (const auto mode = missing_mode(residuals, modes)) {
    checks.missing_mode = mode->frequency;
    remarks.push_back(
        warning({.code = FindingCode::mode_missing,
                 .evidence = {{"frequency", hertz(mode->frequency)}, {"damping_ratio", mode->damping_ratio}}}));
  }
  if (fit.model_error > notable_model_error) remarks.push_back(largest_model_error(residuals, fit.model_error));
  return checks;
}

}  // namespace zwidth::internal
