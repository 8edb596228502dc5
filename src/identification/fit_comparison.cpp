#include "identification/fit_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "identification/student_t.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {

std::optional<ParameterFit> fitted_from(DeviceParameters start, std::vector<std::string> free,
                                        const Identification& result, const IdentifyOptions& options) try {
  if (free.empty()) return std::nullopt;
  ParameterFitOptions fit_options = options.fit;
  fit_options.start = ParameterFitOptions::Start::from_structure;
  fit_options.free = std::move(free);
  return fit_parameters(Device(std::move(start)), result.response, fit_options);
} catch (const Error&) {
  return std::nullopt;
}

bool stands_still(const ParameterFit& before, const ParameterFit& after) {
  constexpr double notable = 0.1;
  for (std::size_t i = 0; i < after.estimates.size(); ++i) {
    const ParameterEstimate& estimate = after.estimates[i];
    const double moved = std::abs(estimate.value - before.estimates[i].value);
    if (estimate.standard_deviation && moved > notable * *estimate.standard_deviation) return false;
  }
  return true;
}

bool explains_more(const ParameterFit& one, const ParameterFit& other) {
  return std::pair(one.model_error, one.misfit) < std::pair(other.model_error, other.misfit);
}

namespace {

/// Independent residuals less the free parameters.
double freedom_of(const ParameterFit& fit, double line_correlation) {
  constexpr double least_freedom = 2.0;
  const double independent = 2.0 * static_cast<double>(fit.frequencies.size()) / line_correlation;
  return std::max(least_freedom, independent - static_cast<double>(fit.estimates.size()));
}

/// Of chi^2, by the first's own residuals.
double growth(const ParameterFit& other, const ParameterFit& first, double freedom) {
  const double ratio = *other.misfit / *first.misfit;
  return (ratio * ratio - 1.0) * freedom;
}

}  // namespace

bool explains_as_much(const ParameterFit& other, const ParameterFit& first, double line_correlation) {
  if (other.model_error > 1.02 * first.model_error + 1e-9) return false;
  if (!other.misfit || !first.misfit) return true;
  const double freedom = freedom_of(first, line_correlation);
  const double t = student_t_quantile(freedom);
  return growth(other, first, freedom) <= t * t;
}

bool is_contradicted(const ParameterFit& other, const ParameterFit& first, double line_correlation) {
  if (!other.misfit || !first.misfit) return other.model_error > 1.02 * first.model_error + 1e-9;
  constexpr double deviations = 5.0;
  return growth(other, first, freedom_of(first, line_correlation)) > deviations * deviations;
}

bool explains_notably_more(const ParameterFit& other, const ParameterFit& first, const FrequencyResponse& response) {
  constexpr std::size_t outliers = 3;
  const std::size_t lines = first.residuals.size();
  if (!other.misfit || !first.misfit || other.residuals.size() != lines || lines <= outliers) return false;
  std::vector<double> gains(lines);
  double left = 0.0;
  auto point = response.points.begin();
  for (std::size_t i = 0; i < lines; ++i) {
    point = std::ranges::lower_bound(point, response.points.end(), first.frequencies[i], {}, &ResponsePoint::frequency);
    if (point == response.points.end()) return false;
    const double variance = point->variance + std::norm(first.model_error * first.fitted[i]);
    left += std::norm(other.residuals[i]) / variance;
    gains[i] = (std::norm(first.residuals[i]) - std::norm(other.residuals[i])) / variance;
  }
  std::ranges::nth_element(gains, gains.begin() + outliers, std::greater{});
  const double gain = std::accumulate(gains.begin() + outliers, gains.end(), 0.0);
  constexpr double deviations = 5.0;
  constexpr double share = 0.1;
  return gain > left * std::max(share, deviations * deviations / freedom_of(first, response.line_correlation));
}

}  // namespace zwidth::internal
