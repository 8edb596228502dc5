#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace zwidth::report {

/// The kind of file that a figure is in, and for whom: a screen, or paper of a width.
struct FigureFormat {
  enum class Kind { svg, png, pdf };
  Kind kind = Kind::svg;
  std::optional<double> paper_width = {};  ///< m; letters then have 8 pt. Absent: 900 px
  [[nodiscard]] bool operator==(const FigureFormat&) const = default;
  static const FigureFormat svg;
  static const FigureFormat png;
  static const FigureFormat pdf;
};
inline const FigureFormat FigureFormat::svg{Kind::svg};
inline const FigureFormat FigureFormat::png{Kind::png};
inline const FigureFormat FigureFormat::pdf{Kind::pdf};

/// m, of a px: 12 px, the size of most letters, are 8 pt.
inline constexpr double px_on_paper = 8.0 / 72.0 * 0.0254 / 12.0;
/// Of paper, m: less has no room for the letters.
inline constexpr double least_paper_width = 0.06;
inline constexpr double largest_paper_width = 1.0;

/// The format that a file name asks for by its extension (any case), if it is one of figures.
[[nodiscard]] std::optional<FigureFormat> figure_format(std::string_view path);

/// Radius of gnuplot's point of size 1, px, as measured.
[[nodiscard]] double point_radius(const FigureFormat& format);

enum class Anchor { left, centre, right };

struct TextStyle {
  Anchor anchor = Anchor::left;
  double size = 13.0;  ///< px
  std::string_view colour = "#1a1a1a";
};

struct LineStyle {
  std::string_view colour = "#1a1a1a";
  double width = 1.0;           ///< px
  std::string_view dash = "1";  ///< a gnuplot dashtype; "1" is solid
};

/// A rectangle of the canvas, in px from its top left corner.
struct Box {
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
};

/// A figure under construction: a gnuplot script laid out in px from the top left corner, so that what stands where is
/// decided here and nothing overlaps by gnuplot's own choice. Text is drawn as it is, but symbols such as K_CR have their
/// subscripts: no markup, no escapes.
class Canvas {
 public:
  Canvas(std::string title, double width, double height);

  /// Drawn with the next plot, at px positions.
  void text(double x, double y, std::string_view content, const TextStyle& style = {});
  void line(double x1, double y1, double x2, double y2, const LineStyle& style);
  /// A point of any gnuplot style: "pt 7 ps 0.8 lc rgb '#c2410c'".
  void marker(double x, double y, std::string_view style);
  void rectangle(const Box& box, std::string_view colour);

  /// Where the next plot has the scale of its colours.
  void colour_box(const Box& box);

  /// Appends gnuplot commands that prepare the next plot.
  void commands(std::string_view text);

  /// Draws one plot in `frame`: `what` follows gnuplot's `plot`. What text(), line() and commands() set up is spent.
  void plot(const Box& frame, std::string_view what);

  /// The picture's bytes, by gnuplot. Throws OutputFailed.
  [[nodiscard]] std::string draw(const FigureFormat& format) const;

  /// Width of text in px, on the safe side.
  [[nodiscard]] static double text_width(std::string_view content, double size);

  /// The text, or as much of its start as `room` px hold, with "…".
  [[nodiscard]] static std::string fitted(std::string_view content, double size, double room);

  /// The text in lines of `room` px, broken at spaces, within a word only where it alone is longer; the last of
  /// `most_lines` fitted().
  [[nodiscard]] static std::vector<std::string> broken(std::string_view content, double size, double room,
                                                       std::size_t most_lines);

 private:
  [[nodiscard]] std::string position(double x, double y) const;

  std::string title_;
  double width_;
  double height_;
  std::string script_;
};

/// "lc rgb ... lw ... dt ..." of a line style.
[[nodiscard]] std::string gnuplot_line(const LineStyle& style);

}  // namespace zwidth::report
