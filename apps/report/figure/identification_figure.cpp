#include "report/figure/identification_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <numbers>
#include <vector>

#include "report/figure/plot.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle fit_style{"#c2410c", 1.6, "1"};
constexpr std::string_view point_colour = "#0b4f9e";
constexpr std::string_view fitted_band_colour = "#c7d7ee";
constexpr LineStyle bound_style{"#555555", 1.0, "(8,4)"};
constexpr double degrees = 180.0 / std::numbers::pi;

/// One line of the figure's data.
struct Row {
  double hz = 0.0;
  double magnitude = 0.0, magnitude_low = 0.0, magnitude_high = 0.0;  ///< dB
  double phase = 0.0, phase_low = 0.0, phase_high = 0.0;              ///< degrees
  double fitted_magnitude = 0.0;
  double fitted_phase = 0.0;
  double radial = 0.0, tangential = 0.0;  ///< measured - fitted along the fitted value and across, in deviations or %
};

/// The angle nearest to `near`, by whole turns.
double unwrapped(double phase, double near) { return phase + 360.0 * std::round((near - phase) / 360.0); }

std::vector<Row> fit_rows(const Identification& identified, bool has_noise) {
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
    // Each part has half of the variance.
    const double unit = has_noise ? std::sqrt(0.5 * point->variance) : 0.01 * std::abs(fit.fitted[i]);
    const std::complex<double> left = fit.residuals[i] * std::conj(fit.fitted[i]) / std::abs(fit.fitted[i]) / unit;
    row.radial = left.real();
    row.tangential = left.imag();
    result.push_back(row);
  }
  return result;
}

double largest_residual(const std::vector<Row>& data) {
  double largest = 0.0;
  for (const Row& row : data) largest = std::max({largest, std::abs(row.radial), std::abs(row.tangential)});
  return largest;
}

std::string dot_marker(std::string_view colour) { return fmt::format("pt 7 ps 0.4 lc rgb '{}'", colour); }

std::string plots(int measured, int low, int high, int fitted) {
  return fmt::format(
      "$rows using 1:{}:{} with filledcurves lc rgb '{}', $rows using 1:{} with points {}, $rows using 1:{} with lines "
      "{}",
      low, high, fitted_band_colour, measured, dot_marker(point_colour), fitted, gnuplot_line(fit_style));
}

}  // namespace

std::string draw_identification(const Identification& identified, FigureFormat format) {
  IdentificationLabels labels;
  labels.title =
      fmt::format("{}, identified from {}{}", display_name(identified.fit.device),
                  std::filesystem::path(identified.source).filename().string(), trust_mark(identified.trust));
  return draw_identification(identified, labels, format);
}

std::string draw_identification(const Identification& identified, const IdentificationLabels& labels,
                                FigureFormat format) {
  const bool has_noise =
      std::ranges::all_of(identified.response.points, [](const ResponsePoint& point) { return point.variance > 0.0; });
  const std::vector<Row> data = fit_rows(identified, has_noise);
  const Heading heading(labels.title,
                        {{labels.points, {}, fitted_band_colour, dot_marker(point_colour)},
                         {"fitted device", fit_style},
                         {"residual of the magnitude", {}, {}, dot_marker(point_colour)},
                         {"residual of the phase", {}, {}, ring_marker(orange)}},
                        has_noise ? "Position over force. Residuals in standard deviations (σ) of the noise: 95 % lie "
                                    "within ±2 where the fit explains the data."
                                  : "Position over force. Residuals in per cent of the fitted response.");
  const Box magnitude_frame{frame_left, frame_right, heading.bottom() + 28.0, heading.bottom() + 318.0};
  const Box phase_frame{frame_left, frame_right, magnitude_frame.bottom + 22.0, magnitude_frame.bottom + 212.0};
  const Box residual_frame{frame_left, frame_right, phase_frame.bottom + 22.0, phase_frame.bottom + 142.0};
  Canvas canvas(labels.title, canvas_width, residual_frame.bottom + 70.0);
  heading.draw(canvas);
  canvas.commands("$rows << EOD");
  double lowest = data.front().magnitude;
  double highest = lowest;
  for (const Row& row : data) {
    canvas.commands(fmt::format("{:.9g} {:.5f} {:.5f} {:.5f} {:.4f} {:.4f} {:.4f} {:.5f} {:.4f} {:.4g} {:.4g}", row.hz,
                                row.magnitude, row.magnitude_low, row.magnitude_high, row.phase, row.phase_low,
                                row.phase_high, row.fitted_magnitude, row.fitted_phase, row.radial, row.tangential));
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
  canvas.commands("set autoscale y\nset ytics 90\nset ylabel 'Phase (degrees)'");
  canvas.commands(frequency_ticks(data.front().hz, data.back().hz));
  canvas.plot(phase_frame, plots(5, 6, 7, 9));
  x_label(canvas, residual_frame, "Frequency (Hz)");
  canvas.commands(
      fmt::format("set ytics autofreq\n{}\nset format x '%g'", y_label(has_noise ? "Residual (σ)" : "Residual (%)")));
  if (has_noise) {
    const double extent = std::max(1.1 * largest_residual(data), 4.0);
    canvas.commands(fmt::format("set yrange [{}:{}]", -extent, extent));
    if (extent < 8.0) canvas.commands("set ytics 2");
  }
  canvas.plot(
      residual_frame,
      fmt::format("{}$rows using 1:11 with points {}, $rows using 1:10 with points {}",
                  has_noise ? fmt::format("-2 with lines {0}, 2 with lines {0}, ", gnuplot_line(bound_style)) : "",
                  ring_marker(orange), dot_marker(point_colour)));
  return canvas.draw(format);
}

}  // namespace zwidth::report
