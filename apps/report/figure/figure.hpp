#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/figure/plot.hpp"

namespace zwidth::report {

/// What is drawn in a panel. Left out where its rows are empty or blank lines alone, and with it those that share them.
struct Series {
  /// Numbers, a line for each point; an empty line breaks a curve. Absent: the rows of the series before, drawn once more.
  std::optional<std::string> rows;
  std::string with;             ///< a style of gnuplot: as_lines(), as_points(), as_area()
  std::string columns = "1:2";  ///< of the rows; empty: `rows` is a function of x
};

[[nodiscard]] std::string as_lines(const LineStyle& style);
[[nodiscard]] std::string as_points(std::string_view marker);
[[nodiscard]] std::string as_area(std::string_view colour);

/// A frame with its axes and what is drawn in it. What `axes` sets holds for the panels after it, too.
struct Panel {
  double above = 26.0;  ///< px from the heading, or from the panel before
  double height = 0.0;  ///< px
  double left = frame_left;
  double right = frame_right;
  bool is_beside = false;  ///< the panel before, instead of below it; on narrow paper below, too
  bool is_placed = false;  ///< left and right are those of the page; else they are moved to it
  std::string axes = {};   ///< gnuplot's commands
  std::string x_label = {};
  std::string y_label = {};
  std::vector<Series> series = {};
  /// Draws lines, boxes and texts by px of the frame.
  std::function<void(Canvas&, const Box&)> marks = {};
};

/// A line of text below the panels.
struct Note {
  std::string text;
  std::string_view colour = ink;
};

/// A figure as what is in it.
struct Figure {
  std::string title;
  std::string subtitle = {};
  std::vector<LegendEntry> legend = {};
  std::vector<Panel> panels = {};
  double below = 62.0;  ///< px below the last panel, to the notes
  std::vector<Note> notes = {};
};

/// Draws the figure. Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string draw(const Figure& figure, const FigureFormat& format);

}  // namespace zwidth::report
