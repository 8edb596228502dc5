#include "report/figure/canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "report/figure/gnuplot.hpp"
#include "report/text/markup.hpp"

namespace zwidth::report {
namespace {

constexpr double metres_per_inch = 0.0254;

std::string terminal(const FigureFormat& format, double width, double height) {
  constexpr double px_per_inch = 96.0;
  // Text is drawn as it is but for symbols: gnuplot_text() says of each which.
  // Our font sizes are px; the Cairo terminals count in points.
  constexpr double point_per_px = 0.75;
  constexpr double pdf_font_scale = 0.56;  // as measured: pdfcairo scales once more
  const double on_paper = format.paper_width ? px_on_paper * px_per_inch / metres_per_inch : 1.0;
  switch (format.kind) {
    case FigureFormat::Kind::svg:
      return fmt::format("svg size {},{} dynamic enhanced font 'Helvetica,13' background '#ffffff'", width, height);
    case FigureFormat::Kind::png: {
      constexpr double dots_per_inch = 600.0;
      constexpr double sharp_on_screen = 2.0;
      const double dots = format.paper_width ? px_on_paper / metres_per_inch * dots_per_inch : sharp_on_screen;
      return fmt::format(
          "pngcairo size {0:.0f},{1:.0f} enhanced font 'Helvetica,13' fontscale {3} linewidth {2} pointscale {2} "
          "background '#ffffff'",
          dots * width, dots * height, dots, dots * point_per_px);
    }
    case FigureFormat::Kind::pdf:
      return fmt::format(
          "pdfcairo size {}in,{}in enhanced font 'Helvetica,13' fontscale {} linewidth {} pointscale {} background "
          "'#ffffff'",
          on_paper * width / px_per_inch, on_paper * height / px_per_inch, on_paper * pdf_font_scale, on_paper * 1.5,
          on_paper);
  }
  return {};
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

std::optional<FigureFormat> figure_format(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  std::string extension(dot == std::string_view::npos ? "" : path.substr(dot + 1));
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (extension == "svg") return FigureFormat::svg;
  if (extension == "png") return FigureFormat::png;
  if (extension == "pdf") return FigureFormat::pdf;
  return std::nullopt;
}

double point_radius(const FigureFormat& format) {
  switch (format.kind) {
    case FigureFormat::Kind::svg:
      return 4.9;
    case FigureFormat::Kind::png:
      return 3.05;
    case FigureFormat::Kind::pdf:
      break;
  }
  return 4.0;
}

Canvas::Canvas(std::string title, double width, double height)
    : title_(std::move(title)), width_(width), height_(height) {}

std::string Canvas::position(double x, double y) const {
  return fmt::format("screen {:.5f},{:.5f}", x / width_, 1.0 - y / height_);
}

void Canvas::text(double x, double y, std::string_view content, const TextStyle& style) {
  const std::string_view anchor = style.anchor == Anchor::left     ? "left"
                                  : style.anchor == Anchor::centre ? "center"
                                                                   : "right";
  // The mode stands behind the position: gnuplot_text() has both.
  const std::string shown = gnuplot_text(content);
  const std::size_t mode = shown.rfind(' ');
  commands(fmt::format("set label {} at {} {} front {} font ',{}' textcolor rgb '{}'", shown.substr(0, mode),
                       position(x, y), anchor, shown.substr(mode + 1), style.size, style.colour));
}

void Canvas::line(double x1, double y1, double x2, double y2, const LineStyle& style) {
  commands(
      fmt::format("set arrow from {} to {} nohead back {}", position(x1, y1), position(x2, y2), gnuplot_line(style)));
}

void Canvas::marker(double x, double y, std::string_view style) {
  commands(fmt::format("set label '' at {} front point {}", position(x, y), style));
}

void Canvas::rectangle(const Box& box, std::string_view colour) {
  commands(fmt::format("set object rectangle from {} to {} back fillcolor rgb '{}' fillstyle solid noborder",
                       position(box.left, box.bottom), position(box.right, box.top), colour));
}

void Canvas::colour_box(const Box& box) {
  commands(fmt::format("set colorbox user origin screen {:.5f},{:.5f} size screen {:.5f},{:.5f}", box.left / width_,
                       1.0 - box.bottom / height_, (box.right - box.left) / width_, (box.bottom - box.top) / height_));
}

void Canvas::commands(std::string_view text) {
  script_ += text;
  script_ += '\n';
}

void Canvas::plot(const Box& frame, std::string_view what) {
  commands(fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset bmargin at screen "
      "{:.5f}",
      frame.left / width_, frame.right / width_, 1.0 - frame.top / height_, 1.0 - frame.bottom / height_));
  commands(fmt::format("plot {}\nunset label\nunset arrow\nunset object", what));
}

std::string Canvas::draw(const FigureFormat& format) const {
  std::string picture =
      run_gnuplot(fmt::format("set encoding utf8\nset terminal {}\nunset key\nset multiplot\n{}unset multiplot\n",
                              terminal(format, width_, height_), script_));
  if (format.kind == FigureFormat::Kind::svg) {
    if (format.paper_width) {
      constexpr double millimetres = 1e3 * px_on_paper;
      replace_all(picture, "<svg \n", "<svg ");
      replace_all(
          picture, "<svg ",
          fmt::format("<svg width=\"{:.4g}mm\" height=\"{:.4g}mm\" ", millimetres * width_, millimetres * height_));
    }
    replace_all(picture, "<title>Gnuplot</title>", fmt::format("<title>{}</title>", escape_markup(title_)));
    // Cells of a map have edges, which a viewer would blur.
    replace_all(picture, "<image ", "<image style='image-rendering:pixelated' ");
    replace_all(picture, "font-family=\"Helvetica\"", "font-family=\"Helvetica, Arial, sans-serif\"");
  }
  return picture;
}

double Canvas::text_width(std::string_view content, double size) {
  // Continuation bytes of UTF-8 take no width. 0.62 em is the mean of DejaVu Sans, the widest face likely to be used.
  const auto letters = std::count_if(content.begin(), content.end(), [](char c) { return (c & 0xc0) != 0x80; });
  return 0.62 * size * static_cast<double>(letters);
}

std::string Canvas::fitted(std::string_view content, double size, double room) {
  std::string shown(content);
  if (text_width(shown, size) <= room) return shown;
  while (!shown.empty() && text_width(shown + "…", size) > room) {
    while (shown.size() > 1 && (shown.back() & 0xc0) == 0x80) shown.pop_back();
    shown.pop_back();
  }
  return shown + "…";
}

std::vector<std::string> Canvas::broken(std::string_view content, double size, double room, std::size_t most_lines) {
  std::vector<std::string> lines;
  while (!content.empty() && lines.size() + 1 < most_lines && text_width(content, size) > room) {
    std::size_t end = 0;  // of what fits, by letters
    std::size_t space = 0;
    for (std::size_t next = 1; next <= content.size(); ++next) {
      if (next < content.size() && (content[next] & 0xc0) == 0x80) continue;  // within a letter
      if (text_width(content.substr(0, next), size) > room) break;
      end = next;
      if (next < content.size() && content[next] == ' ') space = next;
    }
    if (space > 0) end = space;
    lines.emplace_back(content.substr(0, end));
    content.remove_prefix(end);
    content.remove_prefix(std::min(content.find_first_not_of(' '), content.size()));
  }
  lines.push_back(fitted(content, size, room));
  return lines;
}

std::string gnuplot_line(const LineStyle& style) {
  return fmt::format("lc rgb '{}' lw {} dt {}", style.colour, style.width, style.dash);
}

}  // namespace zwidth::report
