#include "identification/critical_hold.hpp"

#include <algorithm>
#include <cmath>

#include "identification/fit_weights.hpp"
#include "zwidth/identification/measured_stiffness.hpp"

namespace zwidth::internal {

std::optional<CriticalPoint> measured_critical_point(const FrequencyResponse& response,
                                                     const ParameterFitOptions& options) {
  if (options.critical_point == ParameterFitOptions::CriticalPoint::free || !options.locked.empty())
    return std::nullopt;
  if (!response.sampling_period || response.points.size() < 2) return std::nullopt;
  const MeasuredStiffness measured = measured_stiffness(response);
  // Whether a softer crossover hides elsewhere does not matter here: this one is measured.
  if (!measured.limit) return std::nullopt;
  const auto above =
      std::ranges::lower_bound(response.points, measured.limit->frequency, {}, &ResponsePoint::frequency);
  const ResponsePoint& nearest = above == response.points.end() ? response.points.back() : *above;
  CriticalPoint critical{{measured.limit->frequency, -1.0 / measured.limit->stiffness, 0.0, 1.0},
                         std::sqrt(nearest.variance) / std::abs(nearest.value),
                         measured.status != MeasuredStiffnessStatus::found,
                         {}};
  for (const Remark& remark : measured.remarks) {
    if (remark.severity != Remark::Severity::warning) continue;
    critical.is_guess = true;
    critical.remarks.push_back(remark);
  }
  return critical;
}

std::optional<Solution> hold(const FitModel& model, const std::vector<ResponsePoint>& points, const Solution& free,
                             const CriticalPoint& critical, double robust_threshold) {
  constexpr double farthest = 0.2;
  constexpr double most_growth = 1.5;
  constexpr double most_model_error = 0.1;  // beyond, the structure is another device's
  if (free.model_error > most_model_error) return std::nullopt;
  if (free.model_error <= 2.0 * critical.relative_deviation) return std::nullopt;
  const std::complex<double> at_point = model.response_at(free.x, {critical.point.frequency})(0);
  const double distance = std::abs(at_point / critical.point.value - 1.0);
  if (distance > std::min(farthest, 5.0 * free.model_error)) return std::nullopt;
  FitData data = fit_data(points, free.model_error);
  data.held = 1;
  data.frequencies.push_back(critical.point.frequency);
  data.measured.push_back(critical.point.value);
  data.deviations.push_back(free.model_error / (10.0 * std::sqrt(static_cast<double>(points.size()))) *
                            std::abs(critical.point.value));
  const LeastSquares fit = least_squares(model, data, free.x, {Misfit::weighted, robust_threshold, 200}, free.pull);
  const double error = model_error_of(points, model.response_at(fit.x, fit_data(points, 0.0).frequencies));
  if (!fit.converged || error > most_growth * free.model_error) return std::nullopt;
  return Solution{fit.x, std::max(error, free.model_error), free.pull, free.settled};
}

}  // namespace zwidth::internal
