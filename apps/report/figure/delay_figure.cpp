#include "report/figure/delay_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace zwidth::report {
namespace {

constexpr std::array<LineStyle, 4> styles = {LineStyle{"#0b4f9e", 2.0, "1"}, LineStyle{"#c2410c", 1.6, "(10,5)"},
                                             LineStyle{"#15803d", 1.8, "(14,4,3,4)"}, LineStyle{"#1a1a1a", 1.4, "1"}};
constexpr double milliseconds = 1e3;

}  // namespace

std::string draw_delay_figure(const std::string& title, const std::vector<DelaySeries>& series, FigureFormat format) {
  constexpr Box frame{84.0, 876.0, 100.0, 420.0};
  Canvas canvas(title, 900.0, 490.0);
  canvas.text(frame.left, 18.0, title, {Anchor::left, 16.0});
  std::string what;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const LineStyle& style = styles.at(i);
    const double left = frame.left + 400.0 * static_cast<double>(i % 2);
    const double y = 46.0 + 22.0 * static_cast<double>(i / 2);
    canvas.commands(fmt::format("$series{} << EOD", i));
    for (const DelayPoint& point : series[i].points) {
      canvas.commands(fmt::format("{:.9g} {:.6f}", milliseconds * point.delay, point.stiffness_db));
    }
    canvas.commands("EOD");
    canvas.text(left + 54.0, y, Canvas::fitted(series[i].name, 12.0, 340.0), {Anchor::left, 12.0});
    if (series[i].kind == DelaySeries::Kind::curve) {
      canvas.line(left, y, left + 46.0, y, style);
      what += fmt::format("$series{} with lines {}, ", i, gnuplot_line(style));
    } else {
      canvas.point(left + 23.0, y, style.colour);
      what += fmt::format("$series{} with points pt 6 ps 0.7 lw 1.3 lc rgb '{}', ", i, style.colour);
    }
  }
  canvas.commands(
      "set tics font ',12' scale 0.6,0.3\nset border lw 0.8\nset grid xtics ytics lw 0.5 lc rgb '#c8c8c8' dt 1 back\n"
      "set ylabel 'Critical stiffness (dB re 1 N/m)' font ',12' offset 0.5,0\nset ytics 5\n"
      // Markers must not lie on the frame.
      "set autoscale xfix\nset offsets graph 0.02, graph 0.02, graph 0.04, graph 0.04");
  canvas.text(0.5 * (frame.left + frame.right), frame.bottom + 42.0, "Delay (ms), besides the zero-order hold",
              {Anchor::centre, 12.0});
  canvas.plot(frame, what + "NaN notitle");
  return canvas.draw(format);
}

}  // namespace zwidth::report
