#include "identification/response_of_device.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "identification/evidence/response_evidence.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {

FrequencyResponse band_of(const FrequencyResponse& response, const ParameterFitOptions& options) {
  FrequencyResponse band = response;
  std::erase_if(band.points, [&](const ResponsePoint& point) {
    return (options.lowest && point.frequency < *options.lowest) ||
           (options.highest && point.frequency > *options.highest);
  });
  if (band.points.empty() && !response.points.empty())
    refuse_member(options.lowest ? "fit.lowest" : "fit.highest", {.code = ProblemCode::band_leaves_no_line});
  return band;
}

void compare_with_response(ParameterFit& fit, const FrequencyResponse& response, const ParameterFitOptions& options) {
  const FrequencyResponse band = band_of(response, options);
  if (band.points.empty()) return;
  const DeviceFamily family(fit.device.parameters(), {}, options.locked);
  const auto errors = ResponseEvidence(family, band).relative_errors(Eigen::VectorXd(0));
  if (!errors) return;
  const auto count = static_cast<Eigen::Index>(band.points.size());
  std::vector<double> beyond_noise;
  double squares = 0.0;
  bool has_noise = true;
  for (Eigen::Index k = 0; k < count; ++k) {
    const ResponsePoint& point = band.points[static_cast<std::size_t>(k)];
    const double size = std::abs(point.value);
    const std::complex<double> error = size * std::complex<double>((*errors)(k), (*errors)(count + k));
    fit.frequencies.push_back(point.frequency);
    fit.fitted.push_back(point.value + error);
    fit.residuals.push_back(-error);
    has_noise = has_noise && point.variance > 0.0;
    squares += std::norm(error) / point.variance;
    beyond_noise.push_back((std::norm(error) - point.variance) / std::norm(point.value));
  }
  if (has_noise) fit.misfit = std::sqrt(squares / static_cast<double>(count));
  const auto middle = beyond_noise.begin() + count / 2;
  std::ranges::nth_element(beyond_noise, middle);
  fit.model_error = std::sqrt(std::max(0.0, *middle));
}

}  // namespace zwidth::internal
