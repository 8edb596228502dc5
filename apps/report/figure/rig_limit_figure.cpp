#include <fmt/format.h>

#include <algorithm>

#include "report/analysed_device.hpp"
#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/quantity.hpp"
#include "zwidth/rig/results.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle measured_trial_style{orange, 1.6, "1"};
constexpr LineStyle predicted_style{blue, 1.6, "(10,5)"};

/// A line from the bottom to the top of the frame.
std::string upright(double at, const LineStyle& style) {
  return fmt::format("\nset arrow from first {0:.9g}, graph 0 to first {0:.9g}, graph 1 nohead {1}", at,
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
    legend.push_back({fmt::format("K_CR predicted with {}, {}", words_of(holder_of(limit.limits)),
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
  std::string lines = fmt::format(
      "set offsets graph 0.04, graph 0.04, graph 0.08, graph 0.08\nset arrow from graph 0, "
      "first 0 to graph 1, first 0 nohead {}",
      gnuplot_line({grey, 1.0, "1"}));
  if (measured.stiffness) lines += upright(*measured.stiffness / unit.size, measured_trial_style);
  if (predicted) lines += upright(limit.predicted.stiffness / unit.size, predicted_style);
  return draw(Figure{.title = fmt::format("Walls tried on the rig: {}", device.name()),
                     .legend = legend,
                     .panels = {{.height = 320.0,
                                 .axes = lines,
                                 .x_label = fmt::format("Stiffness of the wall ({}{})", unit.prefix, units.stiffness),
                                 .y_label = "Growth of the oscillation (1/s)",
                                 .series = {{rows, "yerrorbars " + ring, "1:2:3"}}}},
                     .below = 70.0},
              format);
}

}  // namespace zwidth::report
