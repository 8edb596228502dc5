#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "results/frf_json.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t most_crossovers = 12;
/// Columns into which the axis is cut when there are more lines than a figure shows: each keeps its extremes.
constexpr std::size_t most_response_lines = 1500;

constexpr LineStyle response_style{"#0b4f9e", 1.8, "1"};
constexpr LineStyle crossover_style{"#777777", 0.8, "(2,3)"};
constexpr LineStyle measured_limit_style{"#b91c1c", 1.2, "1"};
constexpr LineStyle reference_style{"#555555", 1.0, "(8,4)"};
constexpr std::string_view interval_colour = "#bcd3ef";
constexpr std::string_view doubt_colour = "#fdeac4";
constexpr double degrees_per_radian = 180.0 / std::numbers::pi;

/// The points of which a figure can show the difference.
std::vector<ResponseLine> thinned(std::vector<ResponseLine> points) {
  if (points.size() <= 3 * most_response_lines) return points;
  const double per_octave =
      static_cast<double>(most_response_lines) / std::log(points.back().frequency / points.front().frequency);
  const auto column_of = [&](const ResponseLine& point) {
    return static_cast<std::size_t>(per_octave * std::log(point.frequency / points.front().frequency));
  };
  std::vector<ResponseLine> kept;
  for (auto first = points.begin(); first != points.end();) {
    const auto end = std::find_if(first, points.end(), [&, column = column_of(*first)](const ResponseLine& point) {
      return column_of(point) != column;
    });
    auto [least, most] = std::minmax_element(
        first, end, [](const ResponseLine& a, const ResponseLine& b) { return a.magnitude < b.magnitude; });
    if (most < least) std::swap(least, most);
    kept.push_back(*least);
    if (most != least) kept.push_back(*most);
    first = end;
  }
  return kept;
}

bool is_critical(const MeasuredResponse& frf, const MeasuredCrossover& crossover) {
  return frf.stiffness->status == MeasuredStiffnessStatus::found && frf.stiffness->limit &&
         frf.stiffness->limit->frequency == crossover.frequency;
}

std::vector<MeasuredCrossover> crossovers_of(const MeasuredResponse& frf) {
  return frf.stiffness ? frf.stiffness->crossovers : std::vector<MeasuredCrossover>{};
}

/// What stands below the frames: the crossovers, then the warnings.
std::vector<Note> notes_of(const MeasuredResponse& frf, const std::string& unit) {
  std::vector<Note> notes;
  const auto add = [&notes](const std::string& text, std::string_view colour = ink) {
    for (std::string& line : Canvas::broken(text, 12.0, frame_right - frame_left, 3)) {
      notes.push_back({std::move(line), colour});
    }
  };
  const std::vector<MeasuredCrossover> crossovers = crossovers_of(frf);
  for (std::size_t i = 0; i < std::min(most_crossovers, crossovers.size()); ++i) {
    const MeasuredCrossover& crossover = crossovers[i];
    const bool critical = is_critical(frf, crossover);
    add(fmt::format("{}   K = {} ({} to {}) at {} Hz ({} to {}){}", i + 1, quantity(crossover.stiffness, unit),
                    quantity(crossover.stiffness_interval.lower, unit),
                    quantity(crossover.stiffness_interval.upper, unit), number(hertz(crossover.frequency)),
                    number(hertz(crossover.frequency_interval.lower)),
                    number(hertz(crossover.frequency_interval.upper)),
                    critical ? (frf.trust.sound() ? ": critical" : ": critical, doubtful") : ""),
        critical ? measured_limit_style.colour : ink);
  }
  if (crossovers.size() > most_crossovers) {
    add(fmt::format("and {} more crossovers, marked without a number", crossovers.size() - most_crossovers));
  }
  add("Bands and intervals: 95 % confidence.");
  for (const Remark& remark : frf.remarks) {
    if (remark.severity == Remark::Severity::warning) add(remark_line(remark));
  }
  return notes;
}

/// Columns: Hz, dB, its bounds, degrees, their bounds, coherence. NaN breaks a band where there is none.
std::string rows_of(const std::vector<ResponseLine>& points, double lowest_db) {
  const auto db = [&](double magnitude) {
    return magnitude > 0.0 ? std::max(decibels(magnitude), lowest_db) : lowest_db;
  };
  const auto cell = [](std::optional<double> value) {
    return value ? fmt::format("{:.6g}", *value) : std::string("NaN");
  };
  std::string rows;
  for (const ResponseLine& point : points) {
    std::optional<double> lower;
    std::optional<double> upper;
    if (point.magnitude_lower) lower = db(*point.magnitude_lower);
    if (point.magnitude_upper) upper = db(*point.magnitude_upper);
    const auto degrees = [](std::optional<double> phase) {
      if (phase) *phase *= degrees_per_radian;
      return phase;
    };
    rows += fmt::format("{:.9g} {:.6g} {} {} {:.6g} {} {} {:.6g}\n", hertz(point.frequency), db(point.magnitude),
                        cell(lower), cell(upper), degrees_per_radian * point.phase, cell(degrees(point.phase_lower)),
                        cell(degrees(point.phase_upper)), point.coherence);
  }
  return rows;
}

AxisRange response_magnitude_axis(const std::vector<ResponseLine>& points, bool has_marks) {
  AxisRange axis{1e300, -1e300};
  for (const ResponseLine& point : points) {
    if (point.magnitude <= 0.0) continue;
    axis.low = std::min(axis.low, decibels(point.magnitude));
    axis.high = std::max(axis.high, decibels(point.magnitude_upper.value_or(point.magnitude)));
  }
  axis.low = 10.0 * std::floor((axis.low - 2.0) / 10.0);
  axis.high = std::max(axis.high + 4.0, axis.low + 20.0);
  if (has_marks) axis.high = axis.low + (axis.high - axis.low) / 0.88;  // room for the tags
  return axis;
}

AxisRange response_phase_axis(const std::vector<ResponseLine>& points) {
  AxisRange axis{1e300, -1e300};
  for (const ResponseLine& point : points) {
    axis.low = std::min(axis.low, degrees_per_radian * point.phase);
    axis.high = std::max(axis.high, degrees_per_radian * point.phase);
  }
  axis.low = std::min(45.0 * std::floor((axis.low - 5.0) / 45.0), -225.0);
  axis.high = std::max(45.0 * std::ceil((axis.high + 5.0) / 45.0), -135.0);
  return axis;
}

/// The crossovers across the frame, numbered in the top frame.
void mark_crossovers(Canvas& canvas, const MeasuredResponse& frf, const AxisRange& axis, const Box& frame,
                     bool is_top) {
  constexpr double apart = 20.0;
  const std::vector<MeasuredCrossover> crossovers = crossovers_of(frf);
  double last_tag = -apart;
  for (std::size_t i = 0; i < crossovers.size(); ++i) {
    const LineStyle& style = is_critical(frf, crossovers[i]) ? measured_limit_style : crossover_style;
    const double x = place_on_log_axis(frame, axis, hertz(crossovers[i].frequency));
    canvas.line(x, is_top ? frame.top + 22.0 : frame.top, x, frame.bottom, style);
    if (is_top && i < most_crossovers) {
      last_tag = std::max(x, last_tag + apart);
      canvas.text(last_tag, frame.top + 12.0, std::to_string(i + 1), {Anchor::centre, 12.0, style.colour});
    }
  }
}

void shade_doubts(Canvas& canvas, const MeasuredResponse& frf, const AxisRange& axis, const Box& frame) {
  if (!frf.stiffness) return;
  for (const Interval& band : frf.stiffness->doubtful_bands) {
    const double left = place_on_log_axis(frame, axis, hertz(band.lower));
    const double right = place_on_log_axis(frame, axis, hertz(band.upper));
    canvas.rectangle({left, std::max(left + 3.0, right), frame.top, frame.bottom}, doubt_colour);
  }
}

}  // namespace

std::string draw_frf(const MeasuredResponse& frf, const results::FrfUnits& units, FigureFormat format) {
  const std::vector<ResponseLine> points = thinned(response_lines(frf.response));
  const AxisRange axis{hertz(frf.response.points.front().frequency) / 1.05,
                       hertz(frf.response.points.back().frequency) * 1.05};
  const AxisRange magnitude = response_magnitude_axis(points, !crossovers_of(frf).empty());
  const AxisRange phase = response_phase_axis(points);
  const std::string rows = rows_of(points, magnitude.low);
  const std::string band = fmt::format("filledcurves lc rgb '{}'", interval_colour);
  const std::string curve = as_lines(response_style);
  const Page page = page_of(format);
  return draw(
      Figure{.title = std::filesystem::path(frf.source).filename().string() + std::string(trust_mark(frf.trust)),
             .subtitle = "Measured response, from commanded force to sensed position",
             .panels = {{.above = 8.0,
                         .height = 270.0,
                         .axes = fmt::format(
                             "set logscale x\nset xrange [{}:{}]\n{}\nset format x ''\nset style fill solid "
                             "1.0 noborder\nset yrange [{}:{}]\nset ytics {}",
                             axis.low, axis.high, decade_ticks("x", axis.low, axis.high, page.right - page.left),
                             magnitude.low, magnitude.high, tick_step(magnitude, 10.0, 10.0)),
                         .y_label = fmt::format("Magnitude (dB re 1 {})", units.compliance()),
                         .series = {{rows, band, "1:3:4"}, {std::nullopt, curve}},
                         .marks =
                             [&](Canvas& canvas, const Box& frame) {
                               shade_doubts(canvas, frf, axis, frame);
                               mark_crossovers(canvas, frf, axis, frame, true);
                             }},
                        {.above = 18.0,
                         .height = 190.0,
                         .axes = fmt::format("set yrange [{}:{}]\nset ytics {}", phase.low, phase.high,
                                             tick_step(phase, 45.0, 6.0)),
                         .y_label = "Phase (degrees)",
                         .series = {{rows, band, "1:6:7"},
                                    {std::nullopt, curve, "1:5"},
                                    {"-180", as_lines(reference_style), ""}},
                         .marks =
                             [&](Canvas& canvas, const Box& frame) {
                               shade_doubts(canvas, frf, axis, frame);
                               mark_crossovers(canvas, frf, axis, frame, false);
                             }},
                        {.above = 18.0,
                         .height = 90.0,
                         .axes = "set yrange [0:1.05]\nset ytics 0.5\nset format x '%g'",
                         .x_label = "Frequency (Hz)",
                         .y_label = "Coherence",
                         .series = {{rows, curve, "1:8"}},
                         .marks = [&](Canvas& canvas,
                                      const Box& frame) { mark_crossovers(canvas, frf, axis, frame, false); }}},
             .below = 66.0,
             .notes = notes_of(frf, units.stiffness())},
      format);
}

}  // namespace zwidth::report
