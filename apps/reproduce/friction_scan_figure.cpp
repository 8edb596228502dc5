#include "reproduce/friction_scan_figure.hpp"

#include <fmt/format.h>

namespace zwidth::report {
namespace {

constexpr Box frequency_frame{84.0, 876.0, 54.0, 234.0};
constexpr Box margin_frame{84.0, 876.0, 262.0, 402.0};
constexpr LineStyle curve_style{"#0b4f9e", 1.8, "1"};
constexpr LineStyle chosen_style{"#b91c1c", 1.2, "(6,4)"};

}  // namespace

std::string draw_friction_scan(const std::string& title, const Table2& table, FigureFormat format) {
  Canvas canvas(title, 900.0, 470.0);
  canvas.text(frequency_frame.left, 18.0, title, {Anchor::left, 16.0});
  const double low = table.friction_scan.front().level;
  const double high = table.friction_scan.back().level;
  const double x = frequency_frame.left +
                   (frequency_frame.right - frequency_frame.left) * (table.friction_level - low) / (high - low);
  canvas.text(x + 8.0, frequency_frame.top + 14.0, fmt::format("chosen: {:.4g}", table.friction_level),
              {Anchor::left, 12.0, chosen_style.colour});
  canvas.line(x, frequency_frame.top, x, margin_frame.bottom, chosen_style);
  canvas.commands("$scan << EOD");
  for (const FrictionTrial& trial : table.friction_scan) {
    canvas.commands(
        fmt::format("{:.6g} {:.6g} {:.6g}", trial.level, 100.0 * trial.error.frequency, trial.error.margin_db));
  }
  canvas.commands("EOD");
  canvas.commands(fmt::format(
      "set tics font ',12' scale 0.6,0.3\nset border lw 0.8\nset grid xtics ytics lw 0.5 lc rgb '#c8c8c8' dt 1 back\n"
      "set xrange [{:.6g}:{:.6g}]\nset yrange [0:*]\nset format x ''\n"
      "set ylabel 'Frequency, rms (%)' font ',12' offset 0.5,0",
      low, high));
  const std::string style = fmt::format("pt 7 ps 0.5 {}", gnuplot_line(curve_style));
  canvas.plot(frequency_frame, fmt::format("$scan using 1:2 with linespoints {}", style));
  canvas.text(0.5 * (margin_frame.left + margin_frame.right), margin_frame.bottom + 42.0,
              "Friction of the handle over the relay's force, F_c/d", {Anchor::centre, 12.0});
  canvas.commands("set format x '%g'\nset ylabel 'Margin, rms (dB)' font ',12' offset 0.5,0");
  canvas.plot(margin_frame, fmt::format("$scan using 1:3 with linespoints {}", style));
  return canvas.draw(format);
}

}  // namespace zwidth::report
