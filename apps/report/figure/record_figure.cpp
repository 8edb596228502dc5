#include "report/figure/record_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "report/figure/plot.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t most_stretches = 2000;
constexpr LineStyle force_style{"#c2410c", 1.4, "1"};
constexpr LineStyle position_style{"#0b4f9e", 1.8, "1"};

}  // namespace

std::string draw_record(const std::string& title, const std::string& subtitle, const ForceAndPosition& record,
                        FigureFormat format) {
  const Units units = units_of(record.motion);
  const std::size_t count = record.force.size();
  double largest = 0.0;
  for (const double each : record.position) largest = std::max(largest, std::abs(each));
  const AxisUnit unit = axis_unit(largest, 0.1);
  const Heading heading(title, {}, subtitle);
  const Box force_frame{frame_left, frame_right, heading.bottom() + 20.0, heading.bottom() + 170.0};
  const Box position_frame{frame_left, frame_right, force_frame.bottom + 28.0, force_frame.bottom + 248.0};
  Canvas canvas(title, canvas_width, position_frame.bottom + 64.0);
  heading.draw(canvas);
  const auto time_of = [&](std::size_t k) { return record.start + static_cast<double>(k) * record.sampling_period; };
  const auto row = [&](std::size_t k, double force, double position) {
    canvas.commands(fmt::format("{:.9g} {:.9g} {:.9g}", time_of(k), force, position / unit.size));
  };
  canvas.commands("$record << EOD");
  const std::size_t stretch = 2 * most_stretches < count ? 1 + (count - 1) / most_stretches : 1;
  for (std::size_t k = 0; k < count; k += stretch) {
    const std::size_t size = std::min(stretch, count - k);
    const auto [least_force, most_force] = std::ranges::minmax(record.force.subspan(k, size));
    const auto [least, most] = std::ranges::minmax(record.position.subspan(k, size));
    row(k, least_force, least);
    if (size > 1) row(k + size / 2, most_force, most);
  }
  canvas.commands("EOD");
  canvas.commands(fmt::format(
      "{}\nset xrange [{:.9g}:{:.9g}]\nset offsets 0, 0, graph 0.08, graph 0.08\nset format x ''\n{}", axes_look(),
      time_of(0), time_of(std::max<std::size_t>(count, 2) - 1), y_label(fmt::format("Force ({})", units.force))));
  canvas.plot(force_frame, fmt::format("$record using 1:2 with steps {}, NaN notitle", gnuplot_line(force_style)));
  x_label(canvas, position_frame, "Time (s)");
  canvas.commands("set format x '%g'\n" + y_label(fmt::format("Position ({}{})", unit.prefix, units.length)));
  canvas.plot(position_frame,
              fmt::format("$record using 1:3 with lines {}, NaN notitle", gnuplot_line(position_style)));
  return canvas.draw(format);
}

}  // namespace zwidth::report
