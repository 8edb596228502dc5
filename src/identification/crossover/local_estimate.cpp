#include "identification/crossover/local_estimate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace zwidth::internal {
namespace {

constexpr std::array<std::size_t, 12> reaches{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
/// A wider fit agrees with a narrower one within this many of the narrower one's standard deviations.
constexpr double agreement = 2.0;
/// The neighbourhood is chosen by the same data, which costs certainty: by this much, as simulated.
constexpr double cost_of_choice = 1.2;
/// Standard deviations by which the misfit may exceed its expectation.
constexpr double most_misfit = 2.0;

struct Fit {
  Estimate middle;       ///< at the sample
  double misfit = 0.0;   ///< sum of squared residuals over variances
  double freedom = 0.0;  ///< samples less coefficients
};

/// Weighted least squares by a parabola around `middle`, in x scaled by the window's half width.
std::optional<Fit> polynomial_fit(std::span<const CurveSample> window, double middle, double correlation) {
  const double scale = std::max(window.back().x - middle, middle - window.front().x);
  const auto count = std::count_if(window.begin(), window.end(), [](const CurveSample& s) { return s.counts; });
  if (count < 3 || !(scale > 0.0)) return std::nullopt;
  constexpr std::ptrdiff_t enough_for_a_parabola = 6;
  const Eigen::Index coefficients = count >= enough_for_a_parabola ? 3 : 2;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  normal.topLeftCorner(coefficients, coefficients).setZero();
  const auto powers = [&](const CurveSample& sample) {
    const double t = (sample.x - middle) / scale;
    return Eigen::Vector3d(1.0, t, coefficients == 3 ? t * t : 0.0);
  };
  for (const CurveSample& sample : window) {
    if (!sample.counts) continue;
    const double weight = 1.0 / (sample.sigma * sample.sigma);
    const Eigen::Vector3d p = powers(sample);
    normal += weight * p * p.transpose();
    right += weight * sample.y * p;
  }
  const Eigen::Matrix3d covariance = normal.inverse();
  Fit fit;
  const Eigen::Vector3d found = covariance * right;
  fit.freedom = static_cast<double>(count - coefficients);
  for (const CurveSample& sample : window) {
    if (!sample.counts) continue;
    const double residual = (sample.y - powers(sample).dot(found)) / sample.sigma;
    fit.misfit += residual * residual;
  }
  const double inflation = std::min(static_cast<double>(count), correlation);
  fit.middle = {found(0), std::sqrt(std::max(0.0, inflation * covariance(0, 0)))};
  if (!std::isfinite(fit.middle.value) || !std::isfinite(fit.middle.sigma)) return std::nullopt;
  return fit;
}

/// The fits around a sample that agree with each other, by rising width.
struct Accepted {
  std::array<Estimate, reaches.size()> estimates;
  std::size_t count = 0;
};

Accepted accepted_fits(std::span<const CurveSample> samples, std::size_t index, double correlation) {
  Accepted accepted;
  double lowest = samples[index].y - agreement * samples[index].sigma;
  double highest = samples[index].y + agreement * samples[index].sigma;
  for (const std::size_t reach : reaches) {
    const std::size_t first = index - std::min(index, reach);
    const std::size_t last = std::min(samples.size() - 1, index + reach);
    auto fit = polynomial_fit(samples.subspan(first, last - first + 1), samples[index].x, correlation);
    if (fit) {
      const Estimate wider = fit->middle;
      const bool fits = fit->misfit <= fit->freedom + most_misfit * std::sqrt(2.0 * fit->freedom);
      if (!fits || wider.value < lowest || wider.value > highest) break;
      accepted.estimates[accepted.count++] = wider;
      lowest = std::max(lowest, wider.value - agreement * wider.sigma);
      highest = std::min(highest, wider.value + agreement * wider.sigma);
    }
    if (first == 0 && last + 1 == samples.size()) break;
  }
  return accepted;
}

}  // namespace

Estimate local_estimate(std::span<const CurveSample> samples, std::size_t index, double correlation) {
  const Accepted accepted = accepted_fits(samples, index, correlation);
  const Estimate own{samples[index].y, samples[index].sigma};
  Estimate best = own;
  for (std::size_t k = 0; k < accepted.count; ++k) {
    const Estimate wider = accepted.estimates[k];
    if (wider.sigma < best.sigma) best = wider;
  }
  if (best.sigma < own.sigma) best.sigma = std::min(cost_of_choice * best.sigma, own.sigma);
  return best;
}

}  // namespace zwidth::internal
