#include "report/figure/frf_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "report/figure/plot.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

constexpr double measured_magnitude_height = 270.0;
constexpr double measured_phase_height = 190.0;
constexpr double coherence_height = 90.0;
constexpr double between_frames = 18.0;
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

struct Range {
  double low = 0.0;
  double high = 0.0;
};

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

/// A line below the frames.
struct ListLine {
  std::string text;
  std::string_view colour;
};

class FrfLayout {
 public:
  FrfLayout(const MeasuredResponse& frf, const std::vector<ListLine>& list, double heading_bottom)
      : low_(hertz(frf.response.points.front().frequency) / 1.05),
        high_(hertz(frf.response.points.back().frequency) * 1.05) {
    const double top = heading_bottom + 8.0;
    magnitude = {frame_left, frame_right, top, top + measured_magnitude_height};
    phase = {frame_left, frame_right, magnitude.bottom + between_frames,
             magnitude.bottom + between_frames + measured_phase_height};
    coherence = {frame_left, frame_right, phase.bottom + between_frames,
                 phase.bottom + between_frames + coherence_height};
    list_top = coherence.bottom + 66.0;
    height = list_top + row_height * static_cast<double>(list.size());
  }

  /// Across the frames, of a frequency in rad/s.
  [[nodiscard]] double x(double frequency) const {
    const double part = std::log(hertz(frequency) / low_) / std::log(high_ / low_);
    return frame_left + (frame_right - frame_left) * std::clamp(part, 0.0, 1.0);
  }

  [[nodiscard]] double low_hz() const { return low_; }
  [[nodiscard]] double high_hz() const { return high_; }

  Box magnitude;
  Box phase;
  Box coherence;
  double list_top = 0.0;
  double height = 0.0;

 private:
  double low_;
  double high_;
};

bool is_critical(const MeasuredResponse& frf, const MeasuredCrossover& crossover) {
  return frf.stiffness->status == MeasuredStiffnessStatus::found && frf.stiffness->limit &&
         frf.stiffness->limit->frequency == crossover.frequency;
}

std::vector<MeasuredCrossover> crossovers_of(const MeasuredResponse& frf) {
  return frf.stiffness ? frf.stiffness->crossovers : std::vector<MeasuredCrossover>{};
}

/// What stands below the frames: the crossovers, then the warnings.
std::vector<ListLine> list_of(const MeasuredResponse& frf, const std::string& unit) {
  std::vector<ListLine> list;
  const auto add = [&list](const std::string& text, std::string_view colour = ink) {
    for (std::string& line : Canvas::broken(text, 12.0, frame_right - frame_left, 3)) {
      list.push_back({std::move(line), colour});
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
  return list;
}

/// Columns: Hz, dB, its bounds, degrees, their bounds, coherence. NaN breaks a band where there is none.
void add_data(Canvas& canvas, const std::vector<ResponseLine>& points, double lowest_db) {
  const auto db = [&](double magnitude) {
    return magnitude > 0.0 ? std::max(decibels(magnitude), lowest_db) : lowest_db;
  };
  const auto cell = [](std::optional<double> value) {
    return value ? fmt::format("{:.6g}", *value) : std::string("NaN");
  };
  canvas.commands("$lines << EOD");
  for (const ResponseLine& point : points) {
    std::optional<double> lower;
    std::optional<double> upper;
    if (point.magnitude_lower) lower = db(*point.magnitude_lower);
    if (point.magnitude_upper) upper = db(*point.magnitude_upper);
    const auto degrees = [](std::optional<double> phase) {
      if (phase) *phase *= degrees_per_radian;
      return phase;
    };
    canvas.commands(fmt::format("{:.9g} {:.6g} {} {} {:.6g} {} {} {:.6g}", hertz(point.frequency), db(point.magnitude),
                                cell(lower), cell(upper), degrees_per_radian * point.phase,
                                cell(degrees(point.phase_lower)), cell(degrees(point.phase_upper)), point.coherence));
  }
  canvas.commands("EOD");
}

Range magnitude_axis(const std::vector<ResponseLine>& points, bool has_marks) {
  Range axis{1e300, -1e300};
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

Range phase_axis(const std::vector<ResponseLine>& points) {
  Range axis{1e300, -1e300};
  for (const ResponseLine& point : points) {
    axis.low = std::min(axis.low, degrees_per_radian * point.phase);
    axis.high = std::max(axis.high, degrees_per_radian * point.phase);
  }
  axis.low = std::min(45.0 * std::floor((axis.low - 5.0) / 45.0), -225.0);
  axis.high = std::max(45.0 * std::ceil((axis.high + 5.0) / 45.0), -135.0);
  return axis;
}

double tick_step(const Range& axis, double step, double most_ticks) {
  while ((axis.high - axis.low) / step > most_ticks) step *= 2.0;
  return step;
}

void draw_marks(Canvas& canvas, const MeasuredResponse& frf, const FrfLayout& layout, const Box& frame) {
  constexpr double apart = 20.0;
  const std::vector<MeasuredCrossover> crossovers = crossovers_of(frf);
  double last_tag = -apart;
  for (std::size_t i = 0; i < crossovers.size(); ++i) {
    const LineStyle& style = is_critical(frf, crossovers[i]) ? measured_limit_style : crossover_style;
    const double x = layout.x(crossovers[i].frequency);
    const bool is_top = &frame == &layout.magnitude;
    canvas.line(x, is_top ? frame.top + 22.0 : frame.top, x, frame.bottom, style);
    if (is_top && i < most_crossovers) {
      last_tag = std::max(x, last_tag + apart);
      canvas.text(last_tag, frame.top + 12.0, std::to_string(i + 1), {Anchor::centre, 12.0, style.colour});
    }
  }
}

void draw_doubts(Canvas& canvas, const MeasuredResponse& frf, const FrfLayout& layout, const Box& frame) {
  if (!frf.stiffness) return;
  for (const Interval& band : frf.stiffness->doubtful_bands) {
    const double left = layout.x(band.lower);
    canvas.rectangle({left, std::max(left + 3.0, layout.x(band.upper)), frame.top, frame.bottom}, doubt_colour);
  }
}

/// A band between two columns and the curve over it.
std::string band_and_curve(int curve, int lower, int upper) {
  return fmt::format("$lines using 1:{}:{} with filledcurves lc rgb '{}', $lines using 1:{} with lines {}", lower,
                     upper, interval_colour, curve, gnuplot_line(response_style));
}

}  // namespace

std::string draw_frf(const MeasuredResponse& frf, const results::FrfUnits& units, FigureFormat format) {
  const std::vector<ResponseLine> points = thinned(response_lines(frf.response));
  const Heading heading(std::filesystem::path(frf.source).filename().string() + std::string(trust_mark(frf.trust)), {},
                        "Measured response, from commanded force to sensed position");
  const std::vector<ListLine> list = list_of(frf, units.stiffness());
  const FrfLayout layout(frf, list, heading.bottom());
  const bool has_marks = !crossovers_of(frf).empty();
  Canvas canvas(frf.source, canvas_width, layout.height);
  const Range magnitude = magnitude_axis(points, has_marks);
  add_data(canvas, points, magnitude.low);

  heading.draw(canvas);
  for (std::size_t i = 0; i < list.size(); ++i) {
    canvas.text(frame_left, layout.list_top + row_height * static_cast<double>(i), list[i].text,
                {Anchor::left, 12.0, list[i].colour});
  }
  canvas.commands(
      fmt::format("{}\nset logscale x\nset xrange [{}:{}]\n{}\nset format x ''\nset style fill solid 1.0 noborder",
                  axes_look(), layout.low_hz(), layout.high_hz(), frequency_ticks(layout.low_hz(), layout.high_hz())));

  draw_doubts(canvas, frf, layout, layout.magnitude);
  draw_marks(canvas, frf, layout, layout.magnitude);
  canvas.commands(fmt::format("set yrange [{}:{}]\nset ytics {}\n{}", magnitude.low, magnitude.high,
                              tick_step(magnitude, 10.0, 10.0),
                              y_label(fmt::format("Magnitude (dB re 1 {})", units.compliance()))));
  canvas.plot(layout.magnitude, band_and_curve(2, 3, 4));

  const Range phase = phase_axis(points);
  draw_doubts(canvas, frf, layout, layout.phase);
  draw_marks(canvas, frf, layout, layout.phase);
  canvas.commands(fmt::format("set yrange [{}:{}]\nset ytics {}\nset ylabel 'Phase (degrees)'", phase.low, phase.high,
                              tick_step(phase, 45.0, 6.0)));
  canvas.plot(layout.phase,
              band_and_curve(5, 6, 7) + fmt::format(", -180 with lines {}", gnuplot_line(reference_style)));

  draw_marks(canvas, frf, layout, layout.coherence);
  x_label(canvas, layout.coherence, "Frequency (Hz)");
  canvas.commands("set yrange [0:1.05]\nset ytics 0.5\nset ylabel 'Coherence'\nset format x '%g'");
  canvas.plot(layout.coherence, fmt::format("$lines using 1:8 with lines {}", gnuplot_line(response_style)));
  return canvas.draw(format);
}

}  // namespace zwidth::report
