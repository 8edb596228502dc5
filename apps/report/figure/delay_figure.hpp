#pragma once

#include <string>
#include <vector>

#include "report/figure/canvas.hpp"

namespace zwidth::report {

struct DelayPoint {
  double delay = 0.0;         ///< s
  double stiffness_db = 0.0;  ///< dB re 1 N/m
};

/// A curve of critical stiffness against the loop's delay, or points measured.
struct DelaySeries {
  enum class Kind { curve, points };
  std::string name;
  Kind kind = Kind::curve;
  std::vector<DelayPoint> points;
};

/// Critical stiffness in dB against delay in ms; at most four series. Throws OutputFailed.
[[nodiscard]] std::string draw_delay_figure(const std::string& title, const std::vector<DelaySeries>& series,
                                            FigureFormat format);

}  // namespace zwidth::report
