#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/figure/canvas.hpp"

namespace zwidth::report {

// What all figures share: the width and its frame, the head with title and legend, the look of axes, their units.

inline constexpr double canvas_width = 900.0;
inline constexpr double frame_left = 84.0;
inline constexpr double frame_right = 876.0;
inline constexpr double row_height = 20.0;
inline constexpr double text_size = 12.0;

/// What a figure's width leaves to its frames, px. Figures are laid out for the first one; draw() moves their frames to any.
struct Page {
  double width = canvas_width;
  double left = frame_left;
  double right = frame_right;
  /// Frames do not stand beside each other, nor do entries of a legend.
  [[nodiscard]] bool is_narrow() const { return width < 700.0; }
};
[[nodiscard]] Page page_of(const FigureFormat& format);

inline constexpr std::string_view ink = "#1a1a1a";
inline constexpr std::string_view blue = "#0b4f9e";
inline constexpr std::string_view orange = "#c2410c";
inline constexpr std::string_view green = "#15803d";
inline constexpr std::string_view purple = "#7e22ce";
inline constexpr std::string_view red = "#b91c1c";
inline constexpr std::string_view grey = "#555555";

/// Of a map: even steps are seen as even, and stay so in grey (viridis, Smith and van der Walt).
inline constexpr std::string_view even_colours =
    "0 '#440154', 1 '#482878', 2 '#3e4989', 3 '#31688e', 4 '#26828e', 5 '#1f9e89', 6 '#35b779', 7 '#6ece58', 8 "
    "'#b5de2b', "
    "9 '#fde725'";

struct LegendEntry {
  std::string text;
  LineStyle line = {};
  std::string_view fill = {};  ///< colour of an area behind the line; empty: none
  std::string marker = {};     ///< a point style of gnuplot instead of the line; empty: none
};

/// The point style of a ring in this colour.
[[nodiscard]] std::string ring_marker(std::string_view colour);

/// Title, remarks below it, and the legend: entries stand two in a row, long ones in rows of their own. Nothing is cut
/// that three lines hold.
class Heading {
 public:
  Heading(const std::string& title, std::vector<LegendEntry> legend, const std::string& subtitle, const Page& page);

  /// px from the top: where the next thing may begin.
  [[nodiscard]] double bottom() const { return bottom_; }
  void draw(Canvas& canvas) const;

 private:
  struct Placed {
    LegendEntry entry;
    double left = 0.0;
    double y = 0.0;
    std::vector<std::string> lines;
  };
  double left_ = 0.0;
  std::vector<std::string> title_;
  std::vector<std::string> subtitle_;
  std::vector<Placed> legend_;
  double bottom_ = 0.0;
};

/// The unit that an axis counts in: values are divided by `size`.
struct AxisUnit {
  double size = 1.0;        ///< in SI
  std::string_view prefix;  ///< "k", "", "m", ...
};

/// The largest prefix in which the largest value is at least `least_shown`; without one for 0.
[[nodiscard]] AxisUnit axis_unit(double largest, double least_shown = 1.0);

/// What an axis shows.
struct AxisRange {
  double low = 0.0;
  double high = 0.0;
};

/// The step, doubled until the range has at most `most_ticks`.
[[nodiscard]] double tick_step(const AxisRange& range, double step, double most_ticks);

/// px of a value on the frame's logarithmic axis; what lies beyond the axis at its end.
[[nodiscard]] double place_on_log_axis(const Box& frame, const AxisRange& range, double value);

/// gnuplot commands that every frame begins with: size of the tics, border, grid behind the curves.
[[nodiscard]] std::string_view axes_look();

/// `set xtics` of the axis "x" over this length at steps of 1, 2 or 5 of a decade, as many as `px` hold.
[[nodiscard]] std::string sparse_ticks(std::string_view axis, double length, double px);

/// `set xtics` of the axis "x" at 1, 2 and 5 of every decade where `room` px hold them: less than one has too few tics otherwise.
[[nodiscard]] std::string decade_ticks(std::string_view axis, double low, double high,
                                       double room = frame_right - frame_left);

}  // namespace zwidth::report
