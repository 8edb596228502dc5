#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/excitation_text.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/signal/power_density.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle signal_style{"#0b4f9e", 1.2, "1"};
constexpr std::size_t most_columns = 1500;
constexpr double first_right = 456.0;  // of the first half second; the last stands beside it
constexpr double last_left = 516.0;
constexpr double shown_decibels = 80.0;  // below the highest density

/// Every sample, or columns of time, least and greatest force.
Series signal_series(const std::vector<double>& samples, double rate, double start = 0.0) {
  const bool envelope = samples.size() > 2 * most_columns;
  const std::size_t columns = envelope ? most_columns : samples.size();
  std::string rows;
  for (std::size_t i = 0; i < columns; ++i) {
    const std::size_t first = i * samples.size() / columns;
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = samples.begin() + static_cast<std::ptrdiff_t>((i + 1) * samples.size() / columns);
    const auto [least, greatest] = std::minmax_element(begin, end);
    rows += fmt::format("{:.9g} {:.6g} {:.6g}\n", start + static_cast<double>(first) / rate, *least, *greatest);
  }
  if (!envelope) return {rows, "steps " + gnuplot_line(signal_style)};
  return {rows, fmt::format("filledcurves lc rgb '{}'", signal_style.colour), "1:2:3"};
}

struct DensityPoint {
  double frequency_hz = 0.0;
  double decibels = 0.0;
};

/// Means over bands that grow with the frequency, as a logarithmic axis shows them.
std::vector<DensityPoint> banded(const PowerDensity& density) {
  constexpr double growth = 1.01;
  std::vector<DensityPoint> points;
  for (std::size_t first = 1; first < density.values.size();) {
    const std::size_t end = std::min(
        density.values.size(), std::max(first + 1, static_cast<std::size_t>(growth * static_cast<double>(first))));
    double sum = 0.0;
    for (std::size_t k = first; k < end; ++k) sum += density.values[k];
    const double mean = sum / static_cast<double>(end - first);
    const double centre = 0.5 * static_cast<double>(first + end - 1) * density.step_hz;
    if (mean > 0.0) points.push_back({centre, 10.0 * std::log10(mean)});
    first = end;
  }
  return points;
}

/// Every line.
std::vector<DensityPoint> lines(const PowerDensity& density) {
  std::vector<DensityPoint> points;
  for (std::size_t k = 1; k < density.values.size(); ++k) {
    const double power = density.values[k];
    if (power > 0.0) points.push_back({static_cast<double>(k) * density.step_hz, 10.0 * std::log10(power)});
  }
  return points;
}

/// A whole period in the middle, away from fades; of an aperiodic signal, or one shorter than its period, nothing.
std::span<const double> one_period(const Excitation& excitation) {
  const std::size_t period = excitation.period;
  if (period == 0 || excitation.samples.size() < period) return {};
  const std::size_t whole = excitation.samples.size() / period;
  return std::span(excitation.samples).subspan(whole / 2 * period, period);
}

}  // namespace

std::string draw_excitation(const Excitation& excitation, FigureFormat format) {
  const double rate = excitation.rate;
  const bool is_rotary = excitation.motion == Motion::rotary;
  const std::span<const double> period = one_period(excitation);
  const std::vector<DensityPoint> points =
      period.empty() ? banded(power_density(excitation.samples, rate)) : lines(power_density(period, rate));
  double highest = -300.0;
  std::string rows;
  for (const DensityPoint& point : points) {
    highest = std::max(highest, point.decibels);
    rows += fmt::format("{:.9g} {:.4f}\n", point.frequency_hz, point.decibels);
  }
  const double top = 10.0 * std::ceil((highest + 1.0) / 10.0);
  const double bottom = top - shown_decibels;
  const double least = points.empty() ? 0.001 * rate : (period.empty() ? 1.0 : 0.5) * points.front().frequency_hz;
  const Panel over_time{.above = 16.0,
                        .height = 170.0,
                        .axes = fmt::format("set xrange [0:{:.9g}]\nset offsets 0, 0, graph 0.05, graph 0.05",
                                            static_cast<double>(excitation.samples.size()) / rate),
                        .x_label = "Time (s)",
                        .y_label = is_rotary ? "Force (N m)" : "Force (N)",
                        .series = {signal_series(excitation.samples, rate)}};
  // A sweep of many seconds is a block over all of it: its first and last half second show what is sent.
  constexpr double shown_seconds = 0.5;
  const auto count = static_cast<std::ptrdiff_t>(std::lround(shown_seconds * rate));
  const bool shows_ends = excitation.samples.size() > 4 * static_cast<std::size_t>(count) && count > 1;
  const auto end_of = [&](bool is_first) {
    const auto begin = is_first ? excitation.samples.begin() : excitation.samples.end() - count;
    const double start =
        is_first ? 0.0 : static_cast<double>(excitation.samples.size() - static_cast<std::size_t>(count)) / rate;
    return Panel{.above = 70.0,
                 .height = 120.0,
                 .left = is_first ? frame_left : last_left,
                 .right = is_first ? first_right : frame_right,
                 .is_beside = !is_first,
                 .axes = fmt::format("set xrange [{:.9g}:{:.9g}]", start, start + shown_seconds),
                 .x_label = is_first ? "Time (s), the first half second" : "Time (s), the last half second",
                 .y_label = over_time.y_label,
                 .series = {signal_series({begin, begin + count}, rate, start)}};
  };
  const Panel density{
      .above = 70.0,
      .height = 210.0,
      .axes = fmt::format("set logscale x\nset format x '%g'\nset mxtics 10\nset grid mxtics\nset offsets 0, 0, 0, 0\n"
                          "set xrange [{:.9g}:{:.9g}]\nset yrange [{:g}:{:g}]\nset ytics 20",
                          std::max(least, 1e-4 * rate), 0.5 * rate, bottom, top),
      .x_label = period.empty() ? "Frequency (Hz)" : "Frequency (Hz), lines of one period",
      .y_label = fmt::format("Power density (dB re 1 {}/Hz)", is_rotary ? "(N m)²" : "N²"),
      .series = {period.empty() ? Series{rows, as_lines(signal_style)}
                                : Series{rows, "vectors nohead " + gnuplot_line(signal_style),
                                         fmt::format("1:({0:g}):(0):($2>{0:g}?$2-{0:g}:0)", bottom)}}};
  std::vector<Panel> panels{over_time};
  if (shows_ends) panels.insert(panels.end(), {end_of(true), end_of(false)});
  panels.push_back(density);
  return draw(Figure{.title = excitation_title(excitation.options), .panels = std::move(panels), .below = 60.0},
              format);
}

}  // namespace zwidth::report
