#pragma once

#include <span>
#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::report {

/// Force and position of a device over the same time.
struct ForceAndPosition {
  std::span<const double> force;     ///< N or N m
  std::span<const double> position;  ///< m or rad, as many
  double start = 0.0;                ///< s, of the first sample
  double sampling_period = 0.0;      ///< s
  Motion motion = Motion::linear;
};

/// The two, one above the other. Of more samples than a figure shows, the extremes of each stretch. Throws OutputFailed.
[[nodiscard]] std::string draw_record(const std::string& title, const std::string& subtitle,
                                      const ForceAndPosition& record, FigureFormat format);

}  // namespace zwidth::report
