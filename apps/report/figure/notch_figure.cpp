#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/designed_notch.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr double canvas_width = 900.0;
constexpr Box drift_frame{84.0, 440.0, 96.0, 400.0};
constexpr Box gain_frame{530.0, 876.0, 96.0, 400.0};
constexpr LineStyle without_style{"#c2410c", 1.8, "(10,5)"};
constexpr LineStyle with_style{"#0b4f9e", 2.2, "1"};
constexpr int gain_points = 400;

std::string axes(const std::string& x_label_range, std::string_view y_label) {
  return fmt::format(
      "set tics font ',12' scale 0.6,0.3\nset border lw 0.8\nset grid xtics ytics lw 0.5 lc rgb '#c8c8c8' dt 1\n"
      "set ylabel '{}' font ',12' offset 0.5,0\nset xtics autofreq\nset ytics autofreq\n{}",
      y_label, x_label_range);
}

void draw_drift(Canvas& canvas, const DesignedNotch& notch, const Units& units) {
  std::string rows;
  double top = 0.0;
  for (const NotchAtDrift& each : notch.design.over_drift) {
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", 100.0 * each.drift, each.without, each.with);
    top = std::max({top, each.without, each.with});
  }
  canvas.commands(fmt::format("$drift << EOD\n{}EOD", rows));
  const double reach = std::max(100.0 * notch.options.drift, 1.0);
  canvas.commands(axes(fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [0:{:.6g}]", -reach, reach, 1.1 * top),
                       fmt::format("Stiffest wall ({})", units.stiffness)));
  canvas.text(0.5 * (drift_frame.left + drift_frame.right), drift_frame.bottom + 42.0, "Shift of the modes (%)",
              {Anchor::centre, 12.0});
  const char* style = notch.design.over_drift.size() > 1 ? "lines" : "points pt 7";
  canvas.plot(drift_frame, fmt::format("$drift using 1:2 with {0} {1} notitle, $drift using 1:3 with {0} {2} notitle",
                                       style, gnuplot_line(without_style), gnuplot_line(with_style)));
}

void draw_gain(Canvas& canvas, const DesignedNotch& notch) {
  const double period = notch.without.device.loop().sampling_period;
  const double nyquist = 0.5 / period;
  const FilterSection section = filter_section(*notch.design.notch, period);
  const double lowest = std::max(1e-3 * nyquist, 0.05 * notch.design.notch->frequency_hz);
  std::string rows;
  for (int i = 0; i <= gain_points; ++i) {
    const double hz = lowest * std::pow(nyquist / lowest, static_cast<double>(i) / gain_points);
    const std::complex<double> value =
        response(section, std::min(2.0 * std::numbers::pi * hz * period, std::numbers::pi));
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", hz, decibels(std::abs(value)),
                        std::arg(value) * 180.0 / std::numbers::pi);
  }
  canvas.commands(fmt::format("$gain << EOD\n{}EOD", rows));
  canvas.commands(
      axes(fmt::format("set logscale x\nset xrange [{:.6g}:{:.6g}]\nset yrange [*:3]\nset y2tics font ',12'\n"
                       "set ytics nomirror\nset y2range [-90:90]\nset y2tics 30\n"
                       "set y2label 'Phase (degrees, dotted)' font ',12'",
                       lowest, nyquist),
           "Gain of the notch (dB)"));
  canvas.text(0.5 * (gain_frame.left + gain_frame.right) - 20.0, gain_frame.bottom + 42.0, "Frequency (Hz)",
              {Anchor::centre, 12.0});
  Box frame = gain_frame;
  frame.right -= 46.0;
  canvas.plot(frame,
              fmt::format("$gain using 1:2 with lines {} notitle, $gain using 1:3 axes x1y2 with lines {} notitle",
                          gnuplot_line(with_style), gnuplot_line({"#555555", 1.2, "(2,4)"})));
}

}  // namespace

std::string draw_notch(const DesignedNotch& notch, FigureFormat format) {
  const Units units = units_of(notch.without.device.parameters().motion);
  const std::string title = "Notch for " + display_name(notch.without.device);
  Canvas canvas(title, canvas_width, 462.0);
  canvas.text(84.0, 18.0, Canvas::fitted(title, 16.0, 790.0), {Anchor::left, 16.0});
  const auto entry = [&](double y, const LineStyle& style, const std::string& text) {
    canvas.line(84.0, y, 130.0, y, style);
    canvas.text(138.0, y, Canvas::fitted(text, 12.0, 730.0), {Anchor::left, 12.0});
  };
  entry(46.0, without_style, fmt::format("without: {} at least", quantity(notch.design.without, units.stiffness)));
  if (notch.design.notch) {
    entry(68.0, with_style,
          fmt::format("with a notch at {:.4g} Hz, damping ratio {:.3g}, depth {:.3g}: {} at least",
                      notch.design.notch->frequency_hz, notch.design.notch->damping_ratio, notch.design.notch->depth,
                      quantity(notch.design.with, units.stiffness)));
  } else {
    canvas.text(138.0, 68.0, "no notch was found that makes the worst wall stiffer", {Anchor::left, 12.0});
  }
  draw_drift(canvas, notch, units);
  if (notch.design.notch) draw_gain(canvas, notch);
  return canvas.draw(format);
}

}  // namespace zwidth::report
