#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/identification_figure.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle measured_signal_style{blue, 3.0, "1"};
constexpr LineStyle fitted_style{orange, 1.4, "1"};
constexpr LineStyle residual_style{blue, 0.8, "1"};
/// Points drawn of a residual: lowest and highest of each of so many stretches of time.
constexpr std::size_t stretches = 1200;

/// A measured signal, and what a fit leaves of it.
struct Signal {
  std::string name;
  std::string quantity;  ///< "Position", "Force"
  std::string_view unit;
  std::vector<double> times;
  std::span<const double> measured;
  std::span<const double> residuals;
};

double largest(std::span<const double> values) {
  double found = 0.0;
  for (const double value : values) found = std::max(found, std::abs(value));
  return found;
}

/// The last tenth: past the transient, and short enough to tell the curves apart.
std::size_t zoom_begin(const Signal& signal) {
  const std::size_t size = signal.times.size();
  return size - std::min(size, std::clamp<std::size_t>(size / 10, 100, 1000));
}

/// A gap is where samples are left out: the curve breaks.
std::string signal_rows(const Signal& signal, std::size_t from, const AxisUnit& unit) {
  const double step = (signal.times.back() - signal.times.front()) / static_cast<double>(signal.times.size() - 1);
  std::string text;
  for (std::size_t i = from; i < signal.times.size(); ++i) {
    if (i > from && signal.times[i] - signal.times[i - 1] > 3.0 * step) text += "\n";
    text += fmt::format("{:.9g} {:.7g} {:.7g}\n", signal.times[i], signal.measured[i] / unit.size,
                        (signal.measured[i] - signal.residuals[i]) / unit.size);
  }
  return text;
}

std::string residual_rows(const Signal& signal, const AxisUnit& unit) {
  const std::size_t length = std::max<std::size_t>(1, signal.times.size() / stretches);
  std::string text;
  for (std::size_t from = 0; from < signal.times.size(); from += length) {
    const auto part = signal.residuals.subspan(from, std::min(length, signal.times.size() - from));
    const auto [low, high] = std::ranges::minmax(part);
    text += fmt::format("{:.9g} {:.5g}\n", signal.times[from], low / unit.size);
    if (high != low) text += fmt::format("{:.9g} {:.5g}\n", signal.times[from], high / unit.size);
  }
  return text;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// About four ticks, at 1, 2 or 5 of a decade, each way from 0.
std::string few_ticks(double largest) {
  const double decade = std::pow(10.0, std::floor(std::log10(0.5 * largest)));
  const double step = 0.5 * largest / decade;
  return fmt::format("set yrange [{0}:{1}]\nset ytics {2}", -1.1 * largest, 1.1 * largest,
                     (step < 1.5   ? 1.0
                      : step < 3.5 ? 2.0
                                   : 5.0) *
                         decade);
}

/// A zoom, and below it what the fit leaves of the whole.
void add_signal_panels(std::vector<Panel>& panels, const Signal& signal) {
  const std::size_t from = zoom_begin(signal);
  const AxisUnit shown = axis_unit(largest(signal.measured.subspan(from)));
  const AxisUnit small = axis_unit(largest(signal.residuals));
  const double extent = largest(signal.residuals);
  const std::string zoomed =
      fmt::format("{}: zoom on {:.4g} to {:.4g} s", signal.name, signal.times[from], signal.times.back());
  const std::string left = fmt::format("residual (measured less fitted) of the whole record: {} rms",
                                       quantity(root_mean_square(signal.residuals), std::string(signal.unit)));
  const std::string rows = signal_rows(signal, from, shown);
  const auto note = [](const std::string& text) {
    return [text](Canvas& canvas, const Box& frame) {
      constexpr double size = TextStyle{}.size;
      canvas.text(frame.left, frame.top - 14.0, Canvas::fitted(text, size, frame.right - frame.left), {.size = size});
    };
  };
  panels.push_back({.above = 30.0,
                    .height = 180.0,
                    .axes = fmt::format("set xrange [{}:{}]\nset autoscale y\nset ytics autofreq\nset format x '%g'",
                                        signal.times[from], signal.times.back()),
                    .x_label = "Time (s)",
                    .y_label = fmt::format("{} ({}{})", signal.quantity, shown.prefix, signal.unit),
                    .series = {{rows, as_lines(measured_signal_style)}, {std::nullopt, as_lines(fitted_style), "1:3"}},
                    .marks = note(zoomed)});
  panels.push_back({.above = 74.0,
                    .height = 110.0,
                    .axes = fmt::format("set xrange [{}:{}]\n{}", signal.times.front(), signal.times.back(),
                                        extent > 0.0 ? few_ticks(extent / small.size) : ""),
                    .x_label = "Time (s)",
                    .y_label = fmt::format("Residual ({}{})", small.prefix, signal.unit),
                    .series = {{residual_rows(signal, small), as_lines(residual_style)}},
                    .marks = note(left)});
}

}  // namespace

std::string draw_identification(const RigidBodyIdentification& identified, FigureFormat format) {
  const RigidBodyFit& fit = identified.fit;
  const Motion motion = identified.device.parameters().motion;
  const Signal signal{std::filesystem::path(identified.source).filename().string(),
                      "Force",
                      motion == Motion::rotary ? "N m" : "N",
                      fit.times,
                      fit.forces,
                      fit.residual_forces};
  Figure figure{
      .title = fmt::format("{}, identified by inverse dynamics{}", display_name(identified.device),
                           trust_mark(identified.trust)),
      .subtitle = fmt::format("Force behind a low-pass of {:.3g} Hz, as fitted; rests of the body are left out.",
                              fit.cutoff_hz),
      .legend = {{"measured", measured_signal_style}, {"mass, friction and offset of the fitted body", fitted_style}},
      .below = 76.0};
  add_signal_panels(figure.panels, signal);
  return draw(figure, format);
}

}  // namespace zwidth::report
