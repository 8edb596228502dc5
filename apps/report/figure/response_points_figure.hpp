#pragma once

#include <string>
#include <vector>

#include "report/figure/canvas.hpp"
#include "zwidth/stability/bode_points.hpp"

namespace zwidth::report {

/// Gains found at frequencies, to be set beside a response.
struct GainPoints {
  struct Point {
    double frequency = 0.0;     ///< rad/s
    double magnitude_db = 0.0;  ///< 20 log10 of position over force
  };
  std::string name;
  std::vector<Point> points;
};

/// The magnitude of one response as a curve, with up to four series of points on it. Throws OutputFailed.
[[nodiscard]] std::string draw_response_points(const std::string& title, const std::string& curve_name,
                                               const std::vector<BodePoint>& curve,
                                               const std::vector<GainPoints>& series, FigureFormat format);

}  // namespace zwidth::report
