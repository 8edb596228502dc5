#include "report/measured_frf.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace zwidth::report {
namespace {

/// "N m" and "m/s" in brackets below a fraction's line.
std::string in_brackets(const std::string& unit) {
  return unit.find_first_of(" /*") == std::string::npos ? unit : "(" + unit + ")";
}

}  // namespace

std::string FrfUnits::stiffness() const { return force + "/" + in_brackets(position); }
std::string FrfUnits::compliance() const { return position + "/" + in_brackets(force); }

MeasuredFrf measured_frf(std::string recording, FrfUnits units, FrequencyResponse response,
                         std::vector<Remark> remarks) {
  MeasuredFrf frf{std::move(recording), std::move(units), std::move(response), std::nullopt, std::move(remarks)};
  if (!frf.response.sampling_period) {
    frf.remarks.push_back({Remark::Severity::warning, "a response without a sampling rate",
                           "hold and delay are not in it, so that it has no critical stiffness; give the rate of a "
                           "sampled one, or fit a device to it"});
  } else if (frf.response.points.size() < 2) {
    frf.remarks.push_back(
        {Remark::Severity::warning, "a response of a single line", "crossovers lie between lines: excite a band"});
  } else {
    frf.stiffness = measured_stiffness(frf.response);
    frf.remarks.insert(frf.remarks.end(), frf.stiffness->remarks.begin(), frf.stiffness->remarks.end());
  }
  return frf;
}

std::vector<FrfPoint> frf_points(const FrequencyResponse& response) {
  constexpr double turn = 2.0 * std::numbers::pi;
  std::vector<FrfPoint> points;
  for (const ResponsePoint& measured : response.points) {
    FrfPoint point;
    point.frequency = measured.frequency;
    point.magnitude = std::abs(measured.value);
    point.coherence = measured.coherence;
    point.phase = std::arg(measured.value);
    if (points.empty()) {
      if (point.phase > 0.25 * turn) point.phase -= turn;
    } else {
      point.phase += turn * std::round((points.back().phase - point.phase) / turn);
    }
    const double radius = confidence_radius(measured, response.averages);
    if (std::isfinite(radius)) {
      point.magnitude_lower = std::max(0.0, point.magnitude - radius);
      point.magnitude_upper = point.magnitude + radius;
      if (radius < point.magnitude) {
        const double half_width = std::asin(radius / point.magnitude);
        point.phase_lower = point.phase - half_width;
        point.phase_upper = point.phase + half_width;
      }
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace zwidth::report
