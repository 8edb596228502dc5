#include "report/figure/relay_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/figure/plot.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr double cycles_shown = 10.0;
constexpr std::size_t most_points = 4000;
constexpr LineStyle force_style{"#c2410c", 1.4, "1"};
constexpr LineStyle position_style{"#0b4f9e", 1.8, "1"};

/// First sample shown.
std::size_t shown_from(const RelayTrial& trial, double sampling_period) {
  if (!trial.result) return 0;
  const double samples = cycles_shown / (hertz(trial.result->frequency) * sampling_period);
  const auto count = static_cast<std::size_t>(std::ceil(samples)) + 1;
  return trial.force.size() > count ? trial.force.size() - count : 0;
}

double largest(const std::vector<double>& position, std::size_t from) {
  double largest = 0.0;
  for (std::size_t k = from; k < position.size(); ++k) largest = std::max(largest, std::abs(position[k]));
  return largest;
}

}  // namespace

std::string draw_relay_record(const std::string& title, const RelayTrial& trial, double sampling_period, Motion motion,
                              FigureFormat format) {
  const Units units = units_of(motion);
  const std::size_t from = shown_from(trial, sampling_period);
  const std::size_t shown = trial.force.size() - from;
  const std::size_t step = 1 + (shown - 1) / most_points;
  const AxisUnit unit = axis_unit(largest(trial.position, from), 0.1);
  const std::string subtitle =
      trial.result ? fmt::format("{:.4f} Hz, {} ({:.2f} dB); the last {:.0f} cycles", hertz(trial.result->frequency),
                                 quantity(trial.result->stiffness, units.stiffness), decibels(trial.result->stiffness),
                                 cycles_shown)
                   : fmt::format("No oscillation: {}", trial.result.error().reason);
  const Heading heading(title, {}, subtitle);
  const Box force_frame{frame_left, frame_right, heading.bottom() + 20.0, heading.bottom() + 170.0};
  const Box position_frame{frame_left, frame_right, force_frame.bottom + 28.0, force_frame.bottom + 248.0};
  Canvas canvas(title, canvas_width, position_frame.bottom + 64.0);
  heading.draw(canvas);
  canvas.commands("$record << EOD");
  for (std::size_t k = from; k < trial.force.size(); k += step) {
    canvas.commands(fmt::format("{:.9g} {:.9g} {:.9g}", static_cast<double>(k) * sampling_period, trial.force[k],
                                trial.position[k] / unit.size));
  }
  canvas.commands("EOD");
  canvas.commands(fmt::format(
      "{}\nset xrange [{:.9g}:{:.9g}]\nset offsets 0, 0, graph 0.08, graph 0.08\nset format x ''\n{}", axes_look(),
      static_cast<double>(from) * sampling_period, static_cast<double>(trial.force.size() - 1) * sampling_period,
      y_label(fmt::format("Force ({})", units.force))));
  canvas.plot(force_frame, fmt::format("$record using 1:2 with steps {}, NaN notitle", gnuplot_line(force_style)));
  x_label(canvas, position_frame, "Time (s)");
  canvas.commands("set format x '%g'\n" + y_label(fmt::format("Position ({}{})", unit.prefix, units.length)));
  canvas.plot(position_frame,
              fmt::format("$record using 1:3 with lines {}, NaN notitle", gnuplot_line(position_style)));
  return canvas.draw(format);
}

std::string draw_relay(const RelayResult& result, FigureFormat format) {
  const auto oscillates = [](const RelayTrial& trial) { return trial.result.has_value(); };
  auto shown = std::find_if(result.trials.begin(), result.trials.end(), oscillates);
  if (shown == result.trials.end()) shown = result.trials.begin();
  const std::string name = result.device ? result.device->name() : result.recording;
  const std::string title = result.trials.size() == 1 ? fmt::format("Relay experiment: {}", name)
                                                      : fmt::format("Relay experiment, trial {}: {}",
                                                                    shown - result.trials.begin() + 1, name);
  return draw_relay_record(title, *shown, result.sampling_period, result.motion, format);
}

}  // namespace zwidth::report
