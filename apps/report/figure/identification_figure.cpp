#include "report/figure/identification_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <numbers>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/output_file.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle fit_style{"#c2410c", 1.0, "1"};
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
    while (point->frequency < fit.frequencies[i] && point + 1 != identified.response.points.end()) ++point;
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

std::string dot_marker(std::string_view colour) { return fmt::format("pt 7 ps 0.3 lc rgb '{}'", colour); }

/// The measured band and points, and the fitted curve, by their columns.
std::vector<Series> band_points_and_fit(std::string_view band, int measured, int fitted) {
  return {{std::nullopt, fmt::format("filledcurves lc rgb '{}'", fitted_band_colour), fmt::format("1:{}", band)},
          {std::nullopt, as_points(dot_marker(point_colour)), fmt::format("1:{}", measured)},
          {std::nullopt, as_lines(fit_style), fmt::format("1:{}", fitted)}};
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
  if (identified.fit.frequencies.empty()) throw OutputFailed("there is no response to draw");
  const bool has_noise =
      std::ranges::all_of(identified.response.points, [](const ResponsePoint& point) { return point.variance > 0.0; });
  const std::vector<Row> data = fit_rows(identified, has_noise);
  std::string rows;
  double lowest = data.front().magnitude;
  double highest = lowest;
  for (const Row& row : data) {
    rows += fmt::format("{:.9g} {:.5f} {:.5f} {:.5f} {:.4f} {:.4f} {:.4f} {:.5f} {:.4f} {:.4g} {:.4g}\n", row.hz,
                        row.magnitude, row.magnitude_low, row.magnitude_high, row.phase, row.phase_low, row.phase_high,
                        row.fitted_magnitude, row.fitted_phase, row.radial, row.tangential);
    lowest = std::min({lowest, row.magnitude, row.fitted_magnitude});
    highest = std::max({highest, row.magnitude, row.fitted_magnitude});
  }
  const std::string_view compliance = identified.fit.device.parameters().motion == Motion::rotary ? "rad/(N m)" : "m/N";
  Panel magnitude{
      .above = 28.0,
      .height = 290.0,
      .axes = fmt::format("set grid mxtics\nset logscale x\nset xrange [{}:{}]\nset format x ''\n"
                          "set yrange [{}:{}]",
                          data.front().hz, std::max(data.back().hz, 1.01 * data.front().hz),
                          10.0 * std::floor((lowest - 1.0) / 10.0), 10.0 * std::ceil((highest + 1.0) / 10.0)),
      .y_label = fmt::format("Magnitude (dB re 1 {})", compliance),
      .series = band_points_and_fit("3:4", 2, 8)};
  const Page page = page_of(format);
  const double room = page.right - page.left;
  Panel phase{.above = 22.0,
              .height = 190.0,
              .axes = "set autoscale y\nset ytics 90\n" + decade_ticks("x", data.front().hz, data.back().hz, room),
              .y_label = "Phase (degrees)",
              .series = band_points_and_fit("6:7", 5, 9)};
  Panel residual{.above = 22.0,
                 .height = 120.0,
                 .axes = "set ytics autofreq\nset format x '%g'",
                 .x_label = "Frequency (Hz)",
                 .y_label = has_noise ? "Residual (σ)" : "Residual (%)"};
  if (has_noise) {
    const double extent = std::max(1.1 * largest_residual(data), 4.0);
    residual.axes += fmt::format("\nset yrange [{}:{}]{}", -extent, extent, extent < 8.0 ? "\nset ytics 2" : "");
    for (const char* bound : {"-2", "2"}) residual.series.push_back({bound, as_lines(bound_style), ""});
  }
  residual.series.push_back({rows, as_points(ring_marker(orange)), "1:11"});
  residual.series.push_back({std::nullopt, as_points(dot_marker(point_colour)), "1:10"});
  magnitude.series.front().rows = rows;
  phase.series.front().rows = rows;
  return draw(
      Figure{.title = labels.title,
             .subtitle = has_noise ? "Position over force. Residuals in standard deviations (σ) of the noise: 95 % lie "
                                     "within ±2 where the fit explains the data."
                                   : "Position over force. Residuals in per cent of the fitted response.",
             .legend = {{labels.points, {}, fitted_band_colour, dot_marker(point_colour)},
                        {"fitted device", fit_style},
                        {"residual of the magnitude", {}, {}, dot_marker(point_colour)},
                        {"residual of the phase", {}, {}, ring_marker(orange)}},
             .panels = {magnitude, phase, residual},
             .below = 70.0},
      format);
}

}  // namespace zwidth::report
