#include "report/figure/response_points_figure.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "report/figure/plot.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle response_curve_style{"#555555", 1.4, "1"};

/// Told apart by shape as well as by colour.
struct Marker {
  int type = 0;  // gnuplot's pt
  std::string_view colour;
};
constexpr std::array<Marker, 4> markers = {Marker{6, "#0b4f9e"}, Marker{7, "#c2410c"}, Marker{9, "#15803d"},
                                           Marker{2, "#7e22ce"}};

}  // namespace

std::string draw_response_points(const std::string& title, const std::string& curve_name,
                                 const std::vector<BodePoint>& curve, const std::vector<GainPoints>& series,
                                 FigureFormat format) {
  std::vector<LegendEntry> legend{{curve_name, response_curve_style}};
  for (std::size_t i = 0; i < series.size(); ++i) {
    legend.push_back({series[i].name,
                      {},
                      {},
                      fmt::format("pt {} ps 0.8 lw 1.4 lc rgb '{}'", markers.at(i).type, markers.at(i).colour)});
  }
  const Heading heading(title, legend);
  const Box frame{frame_left, frame_right, heading.bottom() + 22.0, heading.bottom() + 382.0};
  Canvas canvas(title, canvas_width, frame.bottom + 70.0);
  heading.draw(canvas);
  canvas.commands("$curve << EOD");
  for (const BodePoint& point : curve) {
    canvas.commands(fmt::format("{:.9g} {:.6f}", point.frequency / (2.0 * std::numbers::pi), point.magnitude_db));
  }
  canvas.commands("EOD");
  std::string what = fmt::format("$curve with lines {}", gnuplot_line(response_curve_style));
  for (std::size_t i = 0; i < series.size(); ++i) {
    canvas.commands(fmt::format("$series{} << EOD", i));
    for (const GainPoints::Point& point : series[i].points) {
      canvas.commands(fmt::format("{:.9g} {:.6f}", point.frequency / (2.0 * std::numbers::pi), point.magnitude_db));
    }
    canvas.commands("EOD");
    what += fmt::format(", $series{} with points {}", i, legend[i + 1].marker);
  }
  x_label(canvas, frame, "Frequency (Hz)");
  canvas.commands(fmt::format("{}\nset grid mxtics\nset logscale x\nset mxtics 10\nset format x '%g'\n{}", axes_look(),
                              y_label("Position over force (dB re 1 m/N)")));
  if (!curve.empty()) {
    canvas.commands(fmt::format("set xrange [{:.9g}:{:.9g}]", curve.front().frequency / (2.0 * std::numbers::pi),
                                curve.back().frequency / (2.0 * std::numbers::pi)));
  }
  canvas.plot(frame, what);
  return canvas.draw(format);
}

}  // namespace zwidth::report
