#include "report/figure/figure.hpp"

#include <fmt/format.h>

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

void draw_panel(Canvas& canvas, const Panel& panel, const Box& frame) {
  const std::string what = plotted(canvas, panel.series);
  if (!panel.axes.empty()) canvas.commands(panel.axes);
  if (!panel.y_label.empty()) {
    canvas.commands(fmt::format("set ylabel {} font ',12' offset 0.5,0", gnuplot_text(panel.y_label)));
  }
  if (!panel.x_label.empty()) {
    canvas.text(0.5 * (frame.left + frame.right), frame.bottom + 42.0, panel.x_label, {Anchor::centre, text_size});
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

std::string draw(const Figure& figure, FigureFormat format) {
  const Heading heading(figure.title, figure.legend, figure.subtitle);
  std::vector<Box> frames;
  double bottom = heading.bottom();
  for (const Panel& panel : figure.panels) {
    const double top = panel.is_beside ? frames.back().top : bottom + panel.above;
    bottom = top + panel.height;
    frames.push_back({panel.left, panel.right, top, bottom});
  }
  double note = bottom + figure.below;
  Canvas canvas(figure.title, canvas_width, note + row_height * static_cast<double>(figure.notes.size()));
  heading.draw(canvas);
  for (const Note& each : figure.notes) {
    canvas.text(frame_left, note, each.text, {Anchor::left, text_size, each.colour});
    note += row_height;
  }
  canvas.commands(axes_look());
  for (std::size_t i = 0; i < frames.size(); ++i) draw_panel(canvas, figure.panels[i], frames[i]);
  return canvas.draw(format);
}

}  // namespace zwidth::report
