#include "report/figure/identification_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "report/figure/plot.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle fit_style{"#c2410c", 1.8, "1"};
constexpr std::string_view point_colour = "#0b4f9e";
constexpr std::string_view fitted_band_colour = "#c7d7ee";
constexpr double degrees = 180.0 / std::numbers::pi;

/// One line of the figure's data.
struct Row {
  double hz = 0.0;
  double magnitude = 0.0, magnitude_low = 0.0, magnitude_high = 0.0;  ///< dB
  double phase = 0.0, phase_low = 0.0, phase_high = 0.0;              ///< degrees
  double fitted_magnitude = 0.0;
  double fitted_phase = 0.0;
};

/// The angle nearest to `near`, by whole turns.
double unwrapped(double phase, double near) { return phase + 360.0 * std::round((near - phase) / 360.0); }

std::vector<Row> rows(const Identification& identified) {
  const ParameterFit& fit = identified.fit;
  std::vector<Row> result;
  double last = -180.0;
  auto point = identified.response.points.begin();
  for (std::size_t i = 0; i < fit.frequencies.size(); ++i) {
    // The fit uses the points of its band, in their order.
    while (point->frequency < fit.frequencies[i]) ++point;
    const double size = std::abs(point->value);
    const double radius = point->variance > 0.0 ? confidence_radius(*point, identified.response.averages) : 0.0;
    const double part = std::min(radius / size, 0.999);  // a larger one leaves the magnitude's lower end open
    Row row;
    row.hz = hertz(point->frequency);
    row.magnitude = decibels(size);
    row.magnitude_low = decibels(size * (1.0 - part));
    row.magnitude_high = std::isfinite(radius) ? decibels(size + radius) : row.magnitude;
    row.fitted_magnitude = decibels(std::abs(fit.fitted[i]));
    row.fitted_phase = unwrapped(degrees * std::arg(fit.fitted[i]), last);
    last = row.fitted_phase;
    row.phase = unwrapped(degrees * std::arg(point->value), row.fitted_phase);
    row.phase_low = row.phase - degrees * std::asin(part);
    row.phase_high = row.phase + degrees * std::asin(part);
    result.push_back(row);
  }
  return result;
}

std::string plots(int measured, int low, int high, int fitted) {
  return fmt::format(
      "$rows using 1:{}:{} with filledcurves lc rgb '{}', $rows using 1:{} with points pt 7 ps 0.25 lc rgb '{}', "
      "$rows using 1:{} with lines {}",
      low, high, fitted_band_colour, measured, point_colour, fitted, gnuplot_line(fit_style));
}

}  // namespace

std::string draw_identification(const Identification& identified, FigureFormat format) {
  IdentificationLabels labels;
  labels.title = fmt::format("{}, identified from {}", display_name(identified.fit.device),
                             std::filesystem::path(identified.source).filename().string());
  return draw_identification(identified, labels, format);
}

std::string draw_identification(const Identification& identified, const IdentificationLabels& labels,
                                FigureFormat format) {
  const std::vector<Row> data = rows(identified);
  const Heading heading(labels.title,
                        {{labels.points, {}, {}, ring_marker(point_colour)}, {"fitted device", fit_style}});
  const Box magnitude_frame{frame_left, frame_right, heading.bottom() + 28.0, heading.bottom() + 318.0};
  const Box phase_frame{frame_left, frame_right, magnitude_frame.bottom + 22.0, magnitude_frame.bottom + 212.0};
  Canvas canvas(labels.title, canvas_width, phase_frame.bottom + 70.0);
  heading.draw(canvas);
  canvas.commands("$rows << EOD");
  double lowest = data.front().magnitude;
  double highest = lowest;
  for (const Row& row : data) {
    canvas.commands(fmt::format("{:.9g} {:.5f} {:.5f} {:.5f} {:.4f} {:.4f} {:.4f} {:.5f} {:.4f}", row.hz, row.magnitude,
                                row.magnitude_low, row.magnitude_high, row.phase, row.phase_low, row.phase_high,
                                row.fitted_magnitude, row.fitted_phase));
    lowest = std::min({lowest, row.magnitude, row.fitted_magnitude});
    highest = std::max({highest, row.magnitude, row.fitted_magnitude});
  }
  canvas.commands("EOD");
  const std::string_view compliance = identified.fit.device.parameters().motion == Motion::rotary ? "rad/(N m)" : "m/N";
  canvas.commands(fmt::format(
      "{}\nset grid mxtics\nset logscale x\nset xrange [{}:{}]\nset format x ''\nset yrange [{}:{}]\n{}", axes_look(),
      data.front().hz, std::max(data.back().hz, 1.01 * data.front().hz), 10.0 * std::floor((lowest - 1.0) / 10.0),
      10.0 * std::ceil((highest + 1.0) / 10.0), y_label(fmt::format("Magnitude (dB re 1 {})", compliance))));
  canvas.plot(magnitude_frame, plots(2, 3, 4, 8));
  x_label(canvas, phase_frame, "Frequency (Hz)");
  canvas.commands("set autoscale y\nset ytics 90\nset ylabel 'Phase (degrees)'\nset format x '%g'");
  canvas.commands(frequency_ticks(data.front().hz, data.back().hz));
  canvas.plot(phase_frame, plots(5, 6, 7, 9));
  return canvas.draw(format);
}

}  // namespace zwidth::report
