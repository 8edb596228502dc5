#include "report/figure/relay_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr double cycles_shown = 10.0;
constexpr std::size_t most_points = 4000;
constexpr Box force_frame{84.0, 876.0, 78.0, 228.0};
constexpr Box position_frame{84.0, 876.0, 256.0, 476.0};
constexpr LineStyle force_style{"#c2410c", 1.4, "1"};
constexpr LineStyle position_style{"#0b4f9e", 1.8, "1"};

/// First sample shown.
std::size_t shown_from(const RelayTrial& trial, double sampling_period) {
  if (!trial.result) return 0;
  const double samples = cycles_shown / (hertz(trial.result->frequency) * sampling_period);
  const auto count = static_cast<std::size_t>(std::ceil(samples)) + 1;
  return trial.force.size() > count ? trial.force.size() - count : 0;
}

struct LengthScale {
  double factor = 1.0;
  std::string_view prefix;
};

/// So that the axis reads in whole numbers.
LengthScale length_scale(const std::vector<double>& position, std::size_t from) {
  double largest = 0.0;
  for (std::size_t k = from; k < position.size(); ++k) largest = std::max(largest, std::abs(position[k]));
  if (largest >= 1.0 || largest == 0.0) return {1.0, ""};
  return largest >= 1e-4 ? LengthScale{1e3, "m"} : LengthScale{1e6, "µ"};
}

}  // namespace

std::string draw_relay_record(const std::string& title, const RelayTrial& trial, double sampling_period, Motion motion,
                              FigureFormat format) {
  const Units units = units_of(motion);
  const std::size_t from = shown_from(trial, sampling_period);
  const std::size_t shown = trial.force.size() - from;
  const std::size_t step = 1 + (shown - 1) / most_points;
  const LengthScale scale = length_scale(trial.position, from);
  Canvas canvas(title, 900.0, 540.0);
  canvas.text(force_frame.left, 18.0, Canvas::fitted(title, 16.0, force_frame.right - force_frame.left),
              {Anchor::left, 16.0});
  const std::string subtitle =
      trial.result ? fmt::format("{:.4f} Hz, {} ({:.2f} dB); the last {:.0f} cycles", hertz(trial.result->frequency),
                                 quantity(trial.result->stiffness, units.stiffness), decibels(trial.result->stiffness),
                                 cycles_shown)
                   : fmt::format("No oscillation: {}", trial.result.error().reason);
  canvas.text(force_frame.left, 46.0, Canvas::fitted(subtitle, 12.0, force_frame.right - force_frame.left),
              {Anchor::left, 12.0});
  canvas.commands("$record << EOD");
  for (std::size_t k = from; k < trial.force.size(); k += step) {
    canvas.commands(fmt::format("{:.9g} {:.9g} {:.9g}", static_cast<double>(k) * sampling_period, trial.force[k],
                                scale.factor * trial.position[k]));
  }
  canvas.commands("EOD");
  canvas.commands(fmt::format(
      "set tics font ',12' scale 0.6,0.3\nset border lw 0.8\nset grid xtics ytics lw 0.5 lc rgb '#c8c8c8' dt 1 back\n"
      "set xrange [{:.9g}:{:.9g}]\nset offsets 0, 0, graph 0.08, graph 0.08\nset format x ''\n"
      "set ylabel 'Force ({})' font ',12' offset 0.5,0",
      static_cast<double>(from) * sampling_period, static_cast<double>(trial.force.size() - 1) * sampling_period,
      units.force));
  canvas.plot(force_frame, fmt::format("$record using 1:2 with steps {}, NaN notitle", gnuplot_line(force_style)));
  canvas.text(0.5 * (position_frame.left + position_frame.right), position_frame.bottom + 42.0, "Time (s)",
              {Anchor::centre, 12.0});
  canvas.commands(fmt::format("set format x '%g'\nset ylabel 'Position ({}{})' font ',12' offset 0.5,0", scale.prefix,
                              units.length));
  canvas.plot(position_frame,
              fmt::format("$record using 1:3 with lines {}, NaN notitle", gnuplot_line(position_style)));
  return canvas.draw(format);
}

}  // namespace zwidth::report
