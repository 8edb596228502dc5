#include "identification/initial_fit/fit_weights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace zwidth::internal {
namespace {

// Even perfect data are not trusted beyond this share of the response: the plant's own rounding and differencing.
constexpr double least_relative_deviation = 1e-9;

double median_ratio(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

FitData fit_data(const std::vector<ResponsePoint>& points, double model_error) {
  FitData data;
  for (const ResponsePoint& point : points) {
    data.frequencies.push_back(point.frequency);
    data.measured.push_back(point.value);
    const double relative = std::max(model_error, least_relative_deviation);
    data.deviations.push_back(std::sqrt(point.variance + relative * relative * std::norm(point.value)));
  }
  return data;
}

double model_error_of(const std::vector<ResponsePoint>& points, const Eigen::VectorXcd& fitted) {
  const auto is_enough = [&](double error) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const ResponsePoint& point = points[i];
      const double relative = std::max(error, least_relative_deviation);
      const double variance = point.variance + relative * relative * std::norm(point.value);
      ratios.push_back(std::norm(point.value - fitted(static_cast<Eigen::Index>(i))) / variance);
    }
    return median_ratio(std::move(ratios)) <= std::numbers::ln2;
  };
  if (is_enough(0.0)) return 0.0;
  double low = std::log(least_relative_deviation);
  double high = std::log(1e3);
  constexpr int halvings = 40;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (is_enough(std::exp(middle)) ? high : low) = middle;
  }
  return std::exp(high);
}

}  // namespace zwidth::internal
