#include "report/figure/bode_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <sstream>

#include "report/figure/plot.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

// Line styles differ in dash as well as in colour: they must be told apart on a grey print.
constexpr std::array<LineStyle, most_curves> curve_styles = {
    LineStyle{"#0b4f9e", 2.0, "1"}, LineStyle{"#c2410c", 1.6, "(10,5)"}, LineStyle{"#15803d", 1.8, "(14,4,3,4)"},
    LineStyle{"#7e22ce", 1.8, "(3,4)"}};
constexpr LineStyle nyquist_style{"#555555", 1.2, "(8,3,2,3,2,3)"};
constexpr LineStyle mark_style{"#777777", 0.8, "(2,3)"};
constexpr LineStyle critical_style{"#b91c1c", 1.2, "1"};

constexpr double magnitude_height = 290.0;
constexpr double phase_height = 190.0;
constexpr double tag_size = 12.0;
/// More than these are marked but not listed.
constexpr std::size_t most_listed = 12;

struct Span {
  double low = 0.0;
  double high = 0.0;
};

template <typename Member>
Span extent(const BodeFigure& figure, Member member) {
  Span extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const BodeCurve& curve : figure.curves) {
    for (const BodePoint& point : curve.points) {
      extent.low = std::min(extent.low, point.*member);
      extent.high = std::max(extent.high, point.*member);
    }
  }
  return extent;
}

/// The magnitude axis, with head room for the tags of the marks.
Span magnitude_axis(const BodeFigure& figure) {
  Span axis = extent(figure, &BodePoint::magnitude_db);
  axis.low = 20.0 * std::floor((axis.low - 2.0) / 20.0);
  axis.high = std::max(axis.high + 4.0, axis.low + 20.0);
  if (!figure.marks.empty()) axis.high = axis.low + (axis.high - axis.low) / 0.88;
  return axis;
}

double tick_step(Span axis, double step, double most_ticks) {
  while ((axis.high - axis.low) / step > most_ticks) step *= 2.0;
  return step;
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

class BodeLayout {
 public:
  BodeLayout(const BodeFigure& figure, double heading_bottom) : figure_(figure) {
    const double top = heading_bottom + 46.0;
    magnitude = {frame_left, frame_right, top, top + magnitude_height};
    phase = {frame_left, frame_right, magnitude.bottom + 22.0, magnitude.bottom + 22.0 + phase_height};
    list_top = phase.bottom + 68.0;
    const std::size_t lines = std::min(figure.marks.size(), most_listed + 1) + figure.notes.size();
    height = list_top + row_height * static_cast<double>(lines);
  }

  [[nodiscard]] double x(double frequency) const {
    return frame_left + (frame_right - frame_left) * std::log(frequency / figure_.range.from) /
                            std::log(figure_.range.to / figure_.range.from);
  }

  Box magnitude;
  Box phase;
  double list_top = 0.0;
  double height = 0.0;

 private:
  const BodeFigure& figure_;
};

std::vector<LegendEntry> legend(const BodeFigure& figure) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) entries.push_back({figure.curves[i].name, curve_styles[i]});
  if (figure.nyquist) {
    entries.push_back(
        {fmt::format("Nyquist, {} rad/s ({} Hz)", number(*figure.nyquist), number(hertz(*figure.nyquist))),
         nyquist_style});
  }
  return entries;
}

/// The number of a mark, and where it stands.
struct Tag {
  std::size_t mark = 0;
  double x = 0.0;
};

/// Tags stand in one row at the top of the magnitude frame, moved sideways where they would touch.
std::vector<Tag> tag_positions(const BodeFigure& figure, const BodeLayout& layout) {
  constexpr double apart = 20.0;
  std::vector<Tag> tags;
  for (std::size_t i = 0; i < std::min(figure.marks.size(), most_listed); ++i) {
    if (is_on_axis(figure.marks[i])) tags.push_back({i, layout.x(figure.marks[i].crossover.frequency)});
  }
  std::sort(tags.begin(), tags.end(), [](const Tag& a, const Tag& b) { return a.x < b.x; });
  for (std::size_t i = 1; i < tags.size(); ++i) tags[i].x = std::max(tags[i].x, tags[i - 1].x + apart);
  double limit = frame_right - apart / 2;
  for (auto tag = tags.rbegin(); tag != tags.rend(); ++tag, limit -= apart) tag->x = std::min(tag->x, limit);
  return tags;
}

void draw_list(Canvas& canvas, const BodeFigure& figure, const BodeLayout& layout) {
  double y = layout.list_top;
  const auto add_line = [&](const std::string& text, std::string_view colour) {
    canvas.text(frame_left, y, Canvas::fitted(text, 12.0, canvas_width - frame_left), {Anchor::left, 12.0, colour});
    y += row_height;
  };
  const std::size_t count = std::min(figure.marks.size(), most_listed);
  for (std::size_t i = 0; i < count; ++i) {
    const Crossover& crossover = figure.marks[i].crossover;
    const std::string frequency =
        is_on_axis(figure.marks[i])
            ? fmt::format("{} rad/s ({} Hz)", number(crossover.frequency), number(hertz(crossover.frequency)))
            : crossover_frequency_text(crossover.frequency) + ", left of the axis";
    add_line(fmt::format("{}   K = {:.2f} dB ({}) at {}{}", i + 1, decibels(crossover.stiffness),
                         quantity(crossover.stiffness, units_of(figure.motion).stiffness), frequency,
                         figure.marks[i].remark),
             is_critical(figure.marks[i]) ? critical_style.colour : "#1a1a1a");
  }
  if (figure.marks.size() > count) {
    add_line(fmt::format("and {} more crossovers, marked without a number", figure.marks.size() - count), "#1a1a1a");
  }
  for (const std::string& note : figure.notes) add_line(note, "#444444");
}

/// Notes broken into lines that fit.
std::vector<std::string> wrapped(const std::vector<std::string>& notes) {
  constexpr std::size_t width = 105;
  std::vector<std::string> lines;
  for (const std::string& note : notes) {
    std::istringstream text(broken(note, width, 0));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
  }
  return lines;
}

/// Lines of the marks: from the tag down to the curve, and through the phase for the critical one.
void draw_mark_lines(Canvas& canvas, const BodeFigure& figure, const BodeLayout& layout, Span magnitude) {
  const Box& box = layout.magnitude;
  const double tag_y = box.top + 12.0;
  for (const Tag& tag : tag_positions(figure, layout)) {
    const BodeMark& mark = figure.marks[tag.mark];
    const LineStyle& style = is_critical(mark) ? critical_style : mark_style;
    const double x = layout.x(mark.crossover.frequency);
    const double part = (-decibels(mark.crossover.stiffness) - magnitude.low) / (magnitude.high - magnitude.low);
    const double y = box.bottom - part * (box.bottom - box.top);
    canvas.text(tag.x, tag_y, std::to_string(tag.mark + 1), {Anchor::centre, tag_size, style.colour});
    canvas.line(tag.x, tag_y + 9.0, x, tag_y + 16.0, style);
    canvas.line(x, tag_y + 16.0, x, is_critical(mark) ? layout.phase.bottom : y, style);
    if (is_critical(mark)) canvas.line(frame_left, y, x, y, mark_style);
  }
}

void add_points(Canvas& canvas, std::string_view name, std::span<const BodeMark> marks, auto&& value) {
  canvas.commands(fmt::format("${} << EOD", name));
  for (const BodeMark& mark : marks) {
    if (!is_on_axis(mark)) continue;
    canvas.commands(fmt::format("{} {} {}", mark.crossover.frequency, value(mark), is_critical(mark) ? 1 : 0));
  }
  canvas.commands("EOD");
}

/// The curves, the Nyquist line and the marks of one frame.
std::string plots(const BodeFigure& figure, int column, std::string_view marks) {
  std::string what;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    // The first curve is the one that matters: on top of the others.
    const std::size_t curve = figure.curves.size() - 1 - i;
    what += fmt::format("$curve{} using 1:{} with lines {}, ", curve, column, gnuplot_line(curve_styles[curve]));
  }
  if (!figure.marks.empty()) {
    what += fmt::format(
        "${0} using 1:($3==0?$2:1/0) with points pt 6 ps 0.7 lw 1.3 lc rgb '#1a1a1a', "
        "${0} using 1:($3==1?$2:1/0) with points pt 7 ps 0.85 lc rgb '{1}', ",
        marks, critical_style.colour);
  }
  // Something is always plotted, so that frame and labels appear.
  return what + "NaN notitle";
}

void draw_nyquist(Canvas& canvas, const BodeFigure& figure, const BodeLayout& layout, const Box& box) {
  if (!figure.nyquist) return;
  const double x = layout.x(*figure.nyquist);
  const double top = &box == &layout.magnitude && !figure.marks.empty() ? box.top + 24.0 : box.top;  // below the tags
  if (x <= frame_right) canvas.line(x, top, x, box.bottom, nyquist_style);
}

}  // namespace

std::string draw(const BodeFigure& given, FigureFormat format) {
  BodeFigure figure = given;
  figure.notes = wrapped(given.notes);
  const Heading heading(figure.title, legend(figure));
  const BodeLayout layout(figure, heading.bottom());
  Canvas canvas(figure.title, canvas_width, layout.height);
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    canvas.commands(fmt::format("$curve{} << EOD", i));
    for (const BodePoint& point : figure.curves[i].points) {
      canvas.commands(fmt::format("{:.9g} {:.6f} {:.4f}", point.frequency, point.magnitude_db, point.phase_deg));
    }
    canvas.commands("EOD");
  }
  const Span magnitude = magnitude_axis(figure);
  add_points(canvas, "magnitudes", figure.marks,
             [](const BodeMark& mark) { return -decibels(mark.crossover.stiffness); });
  add_points(canvas, "phases", figure.marks, [&](const BodeMark& mark) {
    return nearest_crossing_phase(phase_at(figure.curves[mark.curve], mark.crossover.frequency));
  });

  const std::string_view compliance = figure.motion == Motion::rotary ? "rad/(N m)" : "m/N";
  canvas.commands(
      fmt::format("{}\nset grid mxtics\nset logscale x\nset logscale x2\nset xrange [{}:{}]\nset x2range [{}:{}]\nset "
                  "mxtics 10\nset format x ''\nset xtics nomirror 10\nset x2tics 10 nomirror\nset mx2tics "
                  "10\nset format x2 '%g'",
                  axes_look(), figure.range.from, figure.range.to, hertz(figure.range.from), hertz(figure.range.to)));

  heading.draw(canvas);
  draw_list(canvas, figure, layout);
  draw_mark_lines(canvas, figure, layout, magnitude);
  draw_nyquist(canvas, figure, layout, layout.magnitude);
  const double centre = 0.5 * (frame_left + frame_right);
  canvas.text(centre, layout.magnitude.top - 38.0, "Frequency (Hz)", {Anchor::centre, 12.0});
  canvas.commands(fmt::format("set yrange [{}:{}]\nset ytics {}\n{}", magnitude.low, magnitude.high,
                              tick_step(magnitude, 10.0, 10.0),
                              y_label(fmt::format("Magnitude (dB re 1 {})", compliance))));
  canvas.plot(layout.magnitude, plots(figure, 2, "magnitudes"));

  Span phase = extent(figure, &BodePoint::phase_deg);
  phase.low = std::min(90.0 * std::floor((phase.low - 1.0) / 90.0), -270.0);
  phase.high = std::max(90.0 * std::ceil((phase.high + 1.0) / 90.0), phase.low + 180.0);
  draw_nyquist(canvas, figure, layout, layout.phase);
  canvas.text(centre, layout.phase.bottom + 42.0, "Frequency (rad/s)", {Anchor::centre, 12.0});
  canvas.commands(
      fmt::format("set yrange [{}:{}]\nset ytics {}\nset ylabel 'Phase (degrees)'\nset format x '%g'\nunset "
                  "x2tics\nset xtics mirror",
                  phase.low, phase.high, tick_step(phase, 90.0, 6.0)));
  canvas.plot(layout.phase, plots(figure, 3, "phases"));
  return canvas.draw(format);
}

}  // namespace zwidth::report
