#include "report/figure/bode_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "report/figure/figure.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

// Line styles differ in dash as well as in colour: they must be told apart on a grey print.
constexpr std::array<LineStyle, most_curves> curve_styles = {
    LineStyle{"#0b4f9e", 2.0, "1"}, LineStyle{"#c2410c", 1.6, "(10,5)"}, LineStyle{"#15803d", 1.8, "(14,4,3,4)"},
    LineStyle{"#7e22ce", 1.8, "(3,4)"}};
constexpr LineStyle nyquist_style{"#555555", 1.2, "(8,3,2,3,2,3)"};
constexpr LineStyle observed_style{"#7e22ce", 2.0, "(3,4)"};
constexpr LineStyle mark_style{"#777777", 0.8, "(2,3)"};
constexpr LineStyle critical_style{"#b91c1c", 1.2, "1"};

constexpr double magnitude_height = 290.0;
constexpr double phase_height = 190.0;
constexpr double between_panels = 22.0;
/// More than these are marked but not listed.
constexpr std::size_t most_listed = 12;

template <typename Member>
AxisRange extent(const BodeFigure& figure, Member member) {
  AxisRange extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const BodeCurve& curve : figure.curves) {
    for (const BodePoint& point : curve.points) {
      extent.low = std::min(extent.low, point.*member);
      extent.high = std::max(extent.high, point.*member);
    }
  }
  return extent;
}

/// The magnitude axis, with head room for the tags of the marks.
AxisRange magnitude_axis(const BodeFigure& figure) {
  AxisRange axis = extent(figure, &BodePoint::magnitude_db);
  axis.low = 20.0 * std::floor((axis.low - 2.0) / 20.0);
  axis.high = std::max(axis.high + 4.0, axis.low + 20.0);
  if (!figure.marks.empty()) axis.high = axis.low + (axis.high - axis.low) / 0.88;
  return axis;
}

/// Phase of the curve at a frequency, by interpolation.
double phase_at(const BodeCurve& curve, double frequency) {
  const auto above = std::lower_bound(curve.points.begin(), curve.points.end(), frequency,
                                      [](const BodePoint& point, double w) { return point.frequency < w; });
  if (above == curve.points.end()) return curve.points.back().phase_deg;
  if (above == curve.points.begin()) return above->phase_deg;
  const BodePoint& below = *(above - 1);
  const double part = (frequency - below.frequency) / (above->frequency - below.frequency);
  return below.phase_deg + part * (above->phase_deg - below.phase_deg);
}

/// A crossover lies where the phase is an odd multiple of half a turn.
double nearest_crossing_phase(double phase) { return 360.0 * std::round((phase + 180.0) / 360.0) - 180.0; }

/// A crossover at 0 Hz has no place on a logarithmic axis; it is only listed.
bool is_on_axis(const BodeMark& mark) { return mark.crossover.frequency > 0.0; }

bool is_critical(const BodeMark& mark) { return mark.rank == BodeMark::Rank::critical; }

AxisRange frequency_axis(const BodeFigure& figure) { return {figure.range.from, figure.range.to}; }

std::vector<LegendEntry> legend(const BodeFigure& figure) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) entries.push_back({figure.curves[i].name, curve_styles[i]});
  if (figure.nyquist) {
    entries.push_back(
        {fmt::format("Nyquist, {} rad/s ({} Hz)", number(*figure.nyquist), number(hertz(*figure.nyquist))),
         nyquist_style});
  }
  if (figure.observed) {
    entries.push_back({fmt::format("It oscillates at {} Hz", number(hertz(*figure.observed))), observed_style});
  }
  return entries;
}

/// The number of a mark, and where it stands.
struct Tag {
  std::size_t mark = 0;
  double x = 0.0;
};

/// Tags stand in one row at the top of the magnitude frame, moved sideways where they would touch.
std::vector<Tag> tag_positions(const BodeFigure& figure, const Box& frame) {
  constexpr double apart = 20.0;
  std::vector<Tag> tags;
  for (std::size_t i = 0; i < std::min(figure.marks.size(), most_listed); ++i) {
    if (!is_on_axis(figure.marks[i])) continue;
    tags.push_back({i, place_on_log_axis(frame, frequency_axis(figure), figure.marks[i].crossover.frequency)});
  }
  std::sort(tags.begin(), tags.end(), [](const Tag& a, const Tag& b) { return a.x < b.x; });
  for (std::size_t i = 1; i < tags.size(); ++i) tags[i].x = std::max(tags[i].x, tags[i - 1].x + apart);
  double limit = frame.right - apart / 2;
  for (auto tag = tags.rbegin(); tag != tags.rend(); ++tag, limit -= apart) tag->x = std::min(tag->x, limit);
  return tags;
}

/// The crossovers, then the notes, in lines that fit.
std::vector<Note> list_of(const BodeFigure& figure) {
  constexpr std::size_t width = 105;
  std::vector<Note> list;
  const auto add = [&list](const std::string& text, std::string_view colour) {
    list.push_back({Canvas::fitted(text, text_size, canvas_width - frame_left), colour});
  };
  const std::size_t count = std::min(figure.marks.size(), most_listed);
  for (std::size_t i = 0; i < count; ++i) {
    const Crossover& crossover = figure.marks[i].crossover;
    const std::string frequency =
        is_on_axis(figure.marks[i])
            ? fmt::format("{} rad/s ({} Hz)", number(crossover.frequency), number(hertz(crossover.frequency)))
            : crossover_frequency_text(crossover.frequency) + ", left of the axis";
    add(fmt::format("{}   K = {:.2f} dB ({}) at {}{}", i + 1, decibels(crossover.stiffness),
                    quantity(crossover.stiffness, units_of(figure.motion).stiffness), frequency,
                    figure.marks[i].remark),
        is_critical(figure.marks[i]) ? critical_style.colour : ink);
  }
  if (figure.marks.size() > count) {
    add(fmt::format("and {} more crossovers, marked without a number", figure.marks.size() - count), ink);
  }
  for (const std::string& note : figure.notes) {
    std::istringstream text(broken(note, width, 0));
    for (std::string line; std::getline(text, line);) add(line, "#444444");
  }
  return list;
}

/// Lines of the marks: from the tag down to the curve, and through the phase for the critical one.
void draw_mark_lines(Canvas& canvas, const BodeFigure& figure, const Box& box, const AxisRange& magnitude) {
  const double tag_y = box.top + 12.0;
  for (const Tag& tag : tag_positions(figure, box)) {
    const BodeMark& mark = figure.marks[tag.mark];
    const LineStyle& style = is_critical(mark) ? critical_style : mark_style;
    const double x = place_on_log_axis(box, frequency_axis(figure), mark.crossover.frequency);
    const double part = (-decibels(mark.crossover.stiffness) - magnitude.low) / (magnitude.high - magnitude.low);
    const double y = box.bottom - part * (box.bottom - box.top);
    canvas.text(tag.x, tag_y, std::to_string(tag.mark + 1), {Anchor::centre, text_size, style.colour});
    canvas.line(tag.x, tag_y + 9.0, x, tag_y + 16.0, style);
    canvas.line(x, tag_y + 16.0, x, is_critical(mark) ? box.bottom + between_panels + phase_height : y, style);
    if (is_critical(mark)) canvas.line(box.left, y, x, y, mark_style);
  }
}

void draw_upright(Canvas& canvas, const BodeFigure& figure, const Box& box, double from) {
  const auto add = [&](const std::optional<double>& frequency, const LineStyle& style) {
    if (!frequency || *frequency < figure.range.from || *frequency > figure.range.to) return;
    const double x = place_on_log_axis(box, frequency_axis(figure), *frequency);
    canvas.line(x, from, x, box.bottom, style);
  };
  add(figure.nyquist, nyquist_style);
  add(figure.observed, observed_style);
}

/// The curves and the marks of one frame: `column` of the points with so many digits, `value` of a mark.
std::vector<Series> curves_and_marks(const BodeFigure& figure, double BodePoint::*column, int digits, auto&& value) {
  std::vector<Series> series;
  // The first curve is the one that matters: on top of the others.
  for (std::size_t curve = figure.curves.size(); curve-- > 0;) {
    std::string rows;
    for (const BodePoint& point : figure.curves[curve].points) {
      rows += fmt::format("{:.9g} {:.{}f}\n", point.frequency, point.*column, digits);
    }
    series.push_back({rows, as_lines(curve_styles[curve])});
  }
  std::string rows;
  for (const BodeMark& mark : figure.marks) {
    if (!is_on_axis(mark)) continue;
    rows += fmt::format("{} {} {}\n", mark.crossover.frequency, value(mark), is_critical(mark) ? 1 : 0);
  }
  series.push_back({rows, as_points("pt 6 ps 0.7 lw 1.3 lc rgb '#1a1a1a'"), "1:($3==0?$2:1/0)"});
  series.push_back(
      {std::nullopt, as_points(fmt::format("pt 7 ps 0.85 lc rgb '{}'", critical_style.colour)), "1:($3==1?$2:1/0)"});
  return series;
}

}  // namespace

std::string draw(const BodeFigure& figure, FigureFormat format) {
  const AxisRange magnitude = magnitude_axis(figure);
  AxisRange phase = extent(figure, &BodePoint::phase_deg);
  phase.low = std::min(90.0 * std::floor((phase.low - 1.0) / 90.0), -270.0);
  phase.high = std::max(90.0 * std::ceil((phase.high + 1.0) / 90.0), phase.low + 180.0);
  const Panel of_magnitude{
      .above = 46.0,
      .height = magnitude_height,
      .axes = fmt::format("set grid mxtics\nset logscale x\nset logscale x2\nset xrange [{}:{}]\nset x2range [{}:{}]\n"
                          "set mxtics 10\nset format x ''\nset xtics nomirror 10\nset x2tics 10 nomirror\nset mx2tics "
                          "10\nset format x2 '%g'\nset yrange [{}:{}]\nset ytics {}",
                          figure.range.from, figure.range.to, hertz(figure.range.from), hertz(figure.range.to),
                          magnitude.low, magnitude.high, tick_step(magnitude, 10.0, 10.0)),
      .y_label = fmt::format("Magnitude (dB re 1 {})", figure.motion == Motion::rotary ? "rad/(N m)" : "m/N"),
      .series = curves_and_marks(figure, &BodePoint::magnitude_db, 6,
                                 [](const BodeMark& mark) { return -decibels(mark.crossover.stiffness); }),
      .marks = [&](Canvas& canvas, const Box& frame) {
        draw_mark_lines(canvas, figure, frame, magnitude);
        draw_upright(canvas, figure, frame, figure.marks.empty() ? frame.top : frame.top + 24.0);  // below the tags
        canvas.text(0.5 * (frame.left + frame.right), frame.top - 38.0, "Frequency (Hz)", {Anchor::centre, text_size});
      }};
  const Panel of_phase{
      .above = between_panels,
      .height = phase_height,
      .axes = fmt::format("set yrange [{}:{}]\nset ytics {}\nset format x '%g'\nunset x2tics\nset xtics mirror",
                          phase.low, phase.high, tick_step(phase, 90.0, 6.0)),
      .x_label = "Frequency (rad/s)",
      .y_label = "Phase (degrees)",
      .series = curves_and_marks(figure, &BodePoint::phase_deg, 4,
                                 [&](const BodeMark& mark) {
                                   return nearest_crossing_phase(
                                       phase_at(figure.curves[mark.curve], mark.crossover.frequency));
                                 }),
      .marks = [&](Canvas& canvas, const Box& frame) { draw_upright(canvas, figure, frame, frame.top); }};
  return draw(Figure{.title = figure.title,
                     .legend = legend(figure),
                     .panels = {of_magnitude, of_phase},
                     .below = 68.0,
                     .notes = list_of(figure)},
              format);
}

}  // namespace zwidth::report
