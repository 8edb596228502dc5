#include "report/figure/response_points_figure.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>

namespace zwidth::report {
namespace {

constexpr LineStyle curve_style{"#555555", 1.4, "1"};

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
  constexpr Box frame{84.0, 876.0, 110.0, 470.0};
  Canvas canvas(title, 900.0, 540.0);
  canvas.text(frame.left, 18.0, Canvas::fitted(title, 16.0, frame.right - frame.left), {Anchor::left, 16.0});
  const auto legend_y = [](std::size_t entry) { return 46.0 + 22.0 * static_cast<double>(entry / 2); };
  const auto legend_x = [](std::size_t entry) { return 84.0 + 400.0 * static_cast<double>(entry % 2); };
  canvas.line(legend_x(0), legend_y(0), legend_x(0) + 46.0, legend_y(0), curve_style);
  canvas.text(legend_x(0) + 54.0, legend_y(0), Canvas::fitted(curve_name, 12.0, 340.0), {Anchor::left, 12.0});
  canvas.commands("$curve << EOD");
  for (const BodePoint& point : curve) {
    canvas.commands(fmt::format("{:.9g} {:.6f}", point.frequency / (2.0 * std::numbers::pi), point.magnitude_db));
  }
  canvas.commands("EOD");
  std::string what = fmt::format("$curve with lines {}", gnuplot_line(curve_style));
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Marker& marker = markers.at(i);
    canvas.commands(fmt::format("$series{} << EOD", i));
    for (const GainPoints::Point& point : series[i].points) {
      canvas.commands(fmt::format("{:.9g} {:.6f}", point.frequency / (2.0 * std::numbers::pi), point.magnitude_db));
    }
    canvas.commands("EOD");
    const std::string style = fmt::format("pt {} ps 0.8 lw 1.4 lc rgb '{}'", marker.type, marker.colour);
    canvas.marker(legend_x(i + 1) + 23.0, legend_y(i + 1), style);
    canvas.text(legend_x(i + 1) + 54.0, legend_y(i + 1), Canvas::fitted(series[i].name, 12.0, 340.0),
                {Anchor::left, 12.0});
    what += fmt::format(", $series{} with points {}", i, style);
  }
  canvas.text(0.5 * (frame.left + frame.right), frame.bottom + 44.0, "Frequency (Hz)", {Anchor::centre, 12.0});
  canvas.commands(
      "set tics font ',12' scale 0.6,0.3\nset border lw 0.8\nset logscale x\nset mxtics 10\nset format x '%g'\n"
      "set grid xtics ytics mxtics lw 0.5 lc rgb '#c8c8c8' dt 1, lw 0.3 lc rgb '#e4e4e4' dt 1 back\n"
      "set ylabel 'Position over force (dB re 1 m/N)' font ',12' offset 0.5,0");
  if (!curve.empty()) {
    canvas.commands(fmt::format("set xrange [{:.9g}:{:.9g}]", curve.front().frequency / (2.0 * std::numbers::pi),
                                curve.back().frequency / (2.0 * std::numbers::pi)));
  }
  canvas.plot(frame, what);
  return canvas.draw(format);
}

}  // namespace zwidth::report
