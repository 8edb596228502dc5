#include "report/figure/record_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "report/figure/figure.hpp"
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
  const auto time_of = [&](std::size_t k) { return record.start + static_cast<double>(k) * record.sampling_period; };
  std::string rows;
  const auto add = [&](std::size_t k, double force, double position) {
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", time_of(k), force, position / unit.size);
  };
  const std::size_t stretch = 2 * most_stretches < count ? 1 + (count - 1) / most_stretches : 1;
  for (std::size_t k = 0; k < count; k += stretch) {
    const std::size_t size = std::min(stretch, count - k);
    const auto [least_force, most_force] = std::ranges::minmax(record.force.subspan(k, size));
    const auto [least, most] = std::ranges::minmax(record.position.subspan(k, size));
    add(k, least_force, least);
    if (size > 1) add(k + size / 2, most_force, most);
  }
  return draw(
      Figure{
          .title = title,
          .subtitle = subtitle,
          .panels = {{.above = 20.0,
                      .height = 150.0,
                      .axes = fmt::format("set xrange [{:.9g}:{:.9g}]\nset offsets 0, 0, graph 0.08, graph 0.08\nset "
                                          "format x ''",
                                          time_of(0), time_of(std::max<std::size_t>(count, 2) - 1)),
                      .y_label = fmt::format("Force ({})", units.force),
                      .series = {{rows, "steps " + gnuplot_line(force_style)}}},
                     {.above = 28.0,
                      .height = 220.0,
                      .axes = "set format x '%g'",
                      .x_label = "Time (s)",
                      .y_label = fmt::format("Position ({}{})", unit.prefix, units.length),
                      .series = {{rows, as_lines(position_style), "1:3"}}}},
          .below = 64.0},
      format);
}

}  // namespace zwidth::report
