#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "zwidth/identification/measured_response.hpp"

namespace zwidth {

std::vector<ResponseLine> response_lines(const FrequencyResponse& response) {
  constexpr double turn = 2.0 * std::numbers::pi;
  std::vector<ResponseLine> lines;
  for (const ResponsePoint& measured : response.points) {
    ResponseLine line;
    line.frequency = measured.frequency;
    line.magnitude = std::abs(measured.value);
    line.coherence = measured.coherence;
    line.phase = std::arg(measured.value);
    if (lines.empty()) {
      if (line.phase > 0.25 * turn) line.phase -= turn;
    } else {
      line.phase += turn * std::round((lines.back().phase - line.phase) / turn);
    }
    const double radius = confidence_radius(measured, response.averages);
    if (std::isfinite(radius)) {
      line.magnitude_lower = std::max(0.0, line.magnitude - radius);
      line.magnitude_upper = line.magnitude + radius;
      if (radius < line.magnitude) {
        const double half_width = std::asin(radius / line.magnitude);
        line.phase_lower = line.phase - half_width;
        line.phase_upper = line.phase + half_width;
      }
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace zwidth
