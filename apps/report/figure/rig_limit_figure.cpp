#include "report/figure/rig_limit_figure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/figure/plot.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle measured_trial_style{orange, 1.6, "1"};
constexpr LineStyle predicted_style{blue, 1.6, "(10,5)"};

/// A line from the bottom to the top of the frame.
std::string upright(double at, const LineStyle& style) {
  return fmt::format("set arrow from first {0:.9g}, graph 0 to first {0:.9g}, graph 1 nohead {1}", at,
                     gnuplot_line(style));
}

}  // namespace

std::string draw_limit_trials(const Device& device, const RigLimit& limit, FigureFormat format) {
  const LimitMeasurement& measured = limit.measured;
  const Units units = units_of(device.parameters().motion);
  const bool predicted = limit.predicted.status == StiffnessStatus::finite;
  const std::string ring = ring_marker(ink);
  std::vector<LegendEntry> legend{{"after a knock, with three deviations", {}, {}, ring}};
  if (measured.stiffness) {
    legend.push_back(
        {fmt::format("K_CR measured, {}", quantity(*measured.stiffness, units.stiffness)), measured_trial_style});
  }
  if (predicted) {
    legend.push_back(
        {fmt::format("K_CR predicted with {}, {}", words_of(limit.limits.user ? Holder::user : Holder::nobody),
                     quantity(limit.predicted.stiffness, units.stiffness)),
         predicted_style});
  }
  double largest = 0.0;
  for (const LimitTrial& trial : measured.trials) largest = std::max(largest, trial.stiffness);
  const AxisUnit unit = axis_unit(largest);
  std::string rows;
  for (const LimitTrial& trial : measured.trials) {
    if (!trial.ring) continue;
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", trial.stiffness / unit.size, trial.ring->growth_rate,
                        3.0 * trial.ring->growth_deviation);
  }
  const std::string title = fmt::format("Walls tried on the rig: {}", device.name());
  const Heading heading(title, legend);
  const Box frame{frame_left, frame_right, heading.bottom() + 26.0, heading.bottom() + 346.0};
  Canvas canvas(title, canvas_width, frame.bottom + 70.0);
  heading.draw(canvas);
  data_block(canvas, "trials", rows);
  canvas.commands(fmt::format("{}\n{}\nset offsets graph 0.04, graph 0.04, graph 0.08, graph 0.08", axes_look(),
                              y_label("Growth of the oscillation (1/s)")));
  if (measured.stiffness) canvas.commands(upright(*measured.stiffness / unit.size, measured_trial_style));
  if (predicted) canvas.commands(upright(limit.predicted.stiffness / unit.size, predicted_style));
  x_label(canvas, frame, fmt::format("Stiffness of the wall ({}{})", unit.prefix, units.stiffness));
  canvas.commands(
      fmt::format("set arrow from graph 0, first 0 to graph 1, first 0 nohead {}", gnuplot_line({grey, 1.0, "1"})));
  canvas.plot(frame, fmt::format("$trials using 1:2:3 with yerrorbars {} notitle", ring));
  return canvas.draw(format);
}

}  // namespace zwidth::report
