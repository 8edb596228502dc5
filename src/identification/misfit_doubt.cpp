#include "identification/misfit_doubt.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

// Beyond the noise, a share of the response that moves a critical stiffness by about as much.
constexpr double doubtful_model_error = 0.05;
// Beyond the noise, and beside it: what is left over shows clearly, so the structure is another one.
constexpr double clear_model_error = 0.01;
// Half of that where the residuals are this many times the noise.
constexpr double clear_misfit = 5.0;
// Of the response: what is left of it below this is the arithmetic's, of a record without noise.
constexpr double rounding_error = 1e-6;
// Of fewer averages than this the noise is itself a guess, and the ratio's tails are long.
constexpr double few_averages = 10.0;
// Of a right structure the residuals are the noise, as far as so many lines tell: of 116 simulated records the fits that
// found the device left at most 1.27 times it, friction 1.48 times with a limit 6 % too high.
double doubtful_misfit(const FrequencyResponse& response, std::size_t lines, double deviations) {
  constexpr double of_few = 2.0;
  if (response.averages < few_averages) return of_few;
  return std::min(of_few, 1.25 + deviations / std::sqrt(static_cast<double>(lines)));
}

/// Root mean square of noise over its deviation as estimated with nu = 2 averages - 2 degrees of freedom.
double expected_misfit(const FrequencyResponse& response) {
  constexpr double least_freedom = 4.0;
  if (!(response.averages > 0.0)) return 1.0;
  const double freedom = std::max(least_freedom, 2.0 * response.averages - 2.0);
  return std::sqrt(freedom / (freedom - 2.0));
}

/// Most that a right structure leaves, times the noise.
double most_misfit(const FrequencyResponse& response, std::size_t lines, double deviations) {
  return doubtful_misfit(response, lines, deviations) * expected_misfit(response);
}

// Of so many looks the most is another deviation more: 1.68 times the noise in 150 fits that found the device.
constexpr double deviations_anywhere = 3.0;
constexpr double deviations_over_all = 2.0;

}  // namespace

double median_noise(const FrequencyResponse& response) {
  std::vector<double> shares;
  for (const ResponsePoint& point : response.points) {
    shares.push_back(std::sqrt(point.variance) / std::abs(point.value));
  }
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  return *middle;
}

bool is_rounding(const ParameterFit& fit, const FrequencyResponse& response) {
  return fit.model_error <= rounding_error && fit.misfit.value_or(0.0) * median_noise(response) <= rounding_error;
}

bool stands_out(const ClearMisfit& left, const FrequencyResponse& response) {
  return left.misfit > most_misfit(response, left.lines, deviations_over_all) ||
         left.local.misfit > most_misfit(response, lines_of_local_misfit, deviations_anywhere);
}

bool leaves_too_much(const ParameterFit& fit, const FrequencyResponse& response) {
  constexpr double poor = 1.25;  // residuals over the noise: a right structure hardly leaves more
  if (fit.misfit && *fit.misfit > poor) return true;
  return fit.clear_misfit && response.averages >= few_averages && stands_out(*fit.clear_misfit, response);
}

std::optional<Finding> doubt_of_misfit(const ParameterFit& fit, const FrequencyResponse& response) {
  const double noise = median_noise(response);
  const bool is_far_above = fit.misfit && *fit.misfit > clear_misfit;
  const bool is_clear = fit.model_error > std::max(is_far_above ? 0.5 * clear_model_error : clear_model_error, noise);
  if (fit.model_error > doubtful_model_error || is_clear) {
    return Finding{.code = FindingCode::residual_beyond_noise, .evidence = {{"unexplained", fit.model_error}}};
  }
  const auto exceeds = [&](double misfit, double most) { return misfit * noise > rounding_error && misfit > most; };
  const std::optional<double> left = fit.clear_misfit ? fit.clear_misfit->misfit : fit.misfit;
  const std::size_t lines = fit.clear_misfit ? fit.clear_misfit->lines : fit.frequencies.size();
  const double most_over_all = most_misfit(response, lines, deviations_over_all);
  if (left && exceeds(*left, most_over_all)) {
    return Finding{.code = FindingCode::residual_above_noise,
                   .evidence = {{"residual", *left}, {"threshold", most_over_all}}};
  }
  // Friction where the device moves stands out of a few lines only, of a band most of which is noise.
  if (!fit.clear_misfit || response.averages < few_averages) return std::nullopt;
  const auto& [misfit, lowest, highest] = fit.clear_misfit->local;
  const double most_anywhere = most_misfit(response, lines_of_local_misfit, deviations_anywhere);
  if (!exceeds(misfit, most_anywhere)) return std::nullopt;
  return Finding{
      .code = FindingCode::residual_above_noise_in_band,
      .evidence = {
          {"lowest", hertz(lowest)}, {"highest", hertz(highest)}, {"residual", misfit}, {"threshold", most_anywhere}}};
}

}  // namespace zwidth::internal
