#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/figure/canvas.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/bode_points.hpp"

namespace zwidth::report {

inline constexpr std::size_t most_curves = 4;

struct BodeCurve {
  std::string name;
  std::vector<BodePoint> points;
};

/// A crossover of one of the curves.
struct BodeMark {
  std::size_t curve = 0;
  Crossover crossover;
  enum class Rank { critical, other } rank = Rank::other;  ///< a critical one is emphasised
  std::string remark;                                      ///< ends its line in the list
};

/// A Bode diagram: magnitude in dB over unwrapped phase in degrees, frequency in rad/s below and Hz above.
struct BodeFigure {
  std::string title;
  Motion motion = Motion::linear;
  FrequencyRange range;
  std::vector<BodeCurve> curves;   ///< at most most_curves
  std::vector<BodeMark> marks;     ///< numbered in this order and listed below the diagram
  std::optional<double> nyquist;   ///< rad/s
  std::optional<double> observed;  ///< rad/s: of an oscillation to explain
  std::vector<std::string> notes;  ///< lines below the list
};

/// Draws the figure. Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string draw(const BodeFigure& figure, FigureFormat format);

}  // namespace zwidth::report
