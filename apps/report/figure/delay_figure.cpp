#include "report/figure/delay_figure.hpp"

#include <fmt/format.h>

#include <array>

#include "report/figure/plot.hpp"

namespace zwidth::report {
namespace {

constexpr std::array<LineStyle, 4> series_styles = {LineStyle{"#0b4f9e", 2.0, "1"}, LineStyle{"#c2410c", 1.6, "(10,5)"},
                                                    LineStyle{"#15803d", 1.8, "(14,4,3,4)"},
                                                    LineStyle{"#1a1a1a", 1.4, "1"}};
constexpr double milliseconds = 1e3;

}  // namespace

std::string draw_delay_figure(const std::string& title, const std::vector<DelaySeries>& series, FigureFormat format) {
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const bool is_curve = series[i].kind == DelaySeries::Kind::curve;
    legend.push_back(
        {series[i].name, series_styles.at(i), {}, is_curve ? std::string() : ring_marker(series_styles.at(i).colour)});
  }
  const Heading heading(title, legend);
  const Box frame{frame_left, frame_right, heading.bottom() + 26.0, heading.bottom() + 346.0};
  Canvas canvas(title, canvas_width, frame.bottom + 70.0);
  heading.draw(canvas);
  std::string what;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const LineStyle& style = series_styles.at(i);
    std::string rows;
    for (const DelayPoint& point : series[i].points) {
      rows += fmt::format("{:.9g} {:.6f}\n", milliseconds * point.delay, point.stiffness_db);
    }
    data_block(canvas, fmt::format("series{}", i), rows);
    what += legend[i].marker.empty() ? fmt::format("$series{} with lines {}, ", i, gnuplot_line(style))
                                     : fmt::format("$series{} with points {}, ", i, legend[i].marker);
  }
  // Offsets: markers must not lie on the frame.
  canvas.commands(
      fmt::format("{}\n{}\nset ytics 5\nset autoscale xfix\nset offsets graph 0.02, graph 0.02, graph 0.04, graph 0.04",
                  axes_look(), y_label("Critical stiffness (dB re 1 N/m)")));
  x_label(canvas, frame, "Delay (ms), besides the zero-order hold");
  canvas.plot(frame, what + "NaN notitle");
  return canvas.draw(format);
}

}  // namespace zwidth::report
