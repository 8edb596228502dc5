#include "report/figure/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "report/figure/gnuplot.hpp"

namespace zwidth::report {
namespace {

/// What follows gnuplot's `plot`, its data set up. Something is always plotted, so that frame and labels appear.
std::string plotted(Canvas& canvas, const std::vector<Series>& series) {
  std::string what;
  std::string name;
  for (const Series& each : series) {
    if (each.rows && each.columns.empty()) {
      what += fmt::format("{} with {} notitle, ", *each.rows, each.with);
      continue;
    }
    if (each.rows) {
      name =
          each.rows->find_first_not_of('\n') == std::string::npos ? "" : fmt::format("data{}", &each - series.data());
      if (!name.empty()) canvas.commands(fmt::format("${} << EOD\n{}EOD", name, *each.rows));
    }
    if (!name.empty()) what += fmt::format("${} using {} with {} notitle, ", name, each.columns, each.with);
  }
  return what + "NaN notitle";
}

/// Where the frames are on a page of that width, as they are laid out for one of 900 px.
std::vector<Box> frames_of(const std::vector<Panel>& panels, double bottom, const Page& page) {
  constexpr double least_below = 70.0;  // with the axis of the panel above
  std::vector<Box> frames;
  for (const Panel& panel : panels) {
    const bool is_beside = panel.is_beside && !page.is_narrow();
    const double above = panel.is_beside ? std::max(panel.above, least_below) : panel.above;
    const double top = is_beside ? frames.back().top : bottom + above;
    bottom = top + panel.height;
    const auto next = frames.size() + 1;
    const bool is_one_of_two = panel.is_beside || (next < panels.size() && panels[next].is_beside);
    const double reserve = panel.is_beside || !is_one_of_two ? frame_right - panel.right : 0.0;  // of a second axis
    double left = page.left + panel.left - frame_left;
    double right = page.right - reserve;
    if (panel.is_placed) {
      left = panel.left, right = panel.right;
    } else if (is_one_of_two && page.is_narrow()) {  // each has the whole width
      left = page.left;
    } else if (is_one_of_two) {
      const double share = (page.right - page.left) / (frame_right - frame_left);
      left = page.left + share * (panel.left - frame_left);
      right = page.left + share * (panel.right - frame_left);
    }
    frames.push_back({left, right, top, bottom});
  }
  return frames;
}

void draw_panel(Canvas& canvas, const Panel& panel, const Box& frame, const Page& page) {
  const std::string what = plotted(canvas, panel.series);
  if (!panel.axes.empty()) canvas.commands(panel.axes);
  if (!panel.y_label.empty()) {
    canvas.commands(fmt::format("set ylabel {} font ',12' offset 0.5,0", gnuplot_text(panel.y_label)));
  }
  if (!panel.x_label.empty()) {
    const double half = 0.5 * Canvas::text_width(panel.x_label, text_size);
    const double middle = std::max(std::min(0.5 * (frame.left + frame.right), page.width - half), half);
    canvas.text(middle, frame.bottom + 42.0, panel.x_label, {Anchor::centre, text_size});
  }
  if (panel.marks) panel.marks(canvas, frame);
  canvas.plot(frame, what);
}

}  // namespace

std::string as_lines(const LineStyle& style) { return "lines " + gnuplot_line(style); }

std::string as_points(std::string_view marker) { return fmt::format("points {}", marker); }

std::string as_area(std::string_view colour) {
  return fmt::format("filledcurves fc rgb '{}' fs solid noborder", colour);
}

std::string draw(const Figure& figure, const FigureFormat& format) {
  const Page page = page_of(format);
  const Heading heading(figure.title, figure.legend, figure.subtitle, page);
  const std::vector<Box> frames = frames_of(figure.panels, heading.bottom(), page);
  const double left = page.is_narrow() ? 0.5 * row_height : page.left;
  std::vector<Note> notes;
  for (const Note& each : figure.notes) {
    if (page.width >= canvas_width) notes.push_back(each);
    if (page.width >= canvas_width) continue;
    constexpr std::size_t most_lines = 4;
    for (std::string& line : Canvas::broken(each.text, text_size, page.width - 2.0 * left, most_lines)) {
      notes.push_back({std::move(line), each.colour});
    }
  }
  double note = frames.back().bottom + figure.below;
  Canvas canvas(figure.title, page.width, note + row_height * static_cast<double>(notes.size()));
  heading.draw(canvas);
  for (const Note& each : notes) {
    canvas.text(left, note, each.text, {Anchor::left, text_size, each.colour});
    note += row_height;
  }
  canvas.commands(axes_look());
  for (std::size_t i = 0; i < frames.size(); ++i) draw_panel(canvas, figure.panels[i], frames[i], page);
  return canvas.draw(format);
}

}  // namespace zwidth::report
