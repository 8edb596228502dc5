#include "report/figure/notch_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "report/figure/plot.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle without_style{"#c2410c", 1.8, "(10,5)"};
constexpr LineStyle with_style{"#0b4f9e", 2.2, "1"};
constexpr int gain_points = 400;

std::string axes(const std::string& ranges, std::string_view label) {
  return fmt::format("{}\n{}\nset xtics autofreq\nset ytics autofreq\n{}", axes_look(), y_label(label), ranges);
}

void draw_modal_shifts(Canvas& canvas, const Box& frame, double uncertainty, const NotchDesign& notch,
                       const Units& units) {
  std::string rows;
  double top = 0.0;
  for (const NotchAtModalShift& each : notch.over_modal_shift) {
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", 100.0 * each.modal_shift, each.without, each.with);
    for (const double limit : {each.without, each.with}) {
      if (std::isfinite(limit)) top = std::max(top, limit);
    }
  }
  if (top == 0.0) top = 1.0;  // no wall keeps the margins: a line at 0
  const AxisUnit unit = axis_unit(top);
  data_block(canvas, "drift", rows);
  const double reach = std::max(100.0 * uncertainty, 1.0);
  canvas.commands(
      axes(fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [0:{:.6g}]", -reach, reach, 1.1 * top / unit.size),
           fmt::format("Stiffest wall ({}{})", unit.prefix, units.stiffness)));
  x_label(canvas, frame, "Shift of the modes (%)");
  const char* style = notch.over_modal_shift.size() > 1 ? "lines" : "points pt 7";
  const std::string with =
      fmt::format(", $drift using 1:($3/{}) with {} {} notitle", unit.size, style, gnuplot_line(with_style));
  canvas.plot(frame, fmt::format("$drift using 1:($2/{}) with {} {} notitle{}", unit.size, style,
                                 gnuplot_line(without_style), notch.notch ? with : ""));
}

void draw_gain(Canvas& canvas, const Box& frame, double period, const NotchDesign& notch) {
  const double nyquist = 0.5 / period;
  const FilterSection section = filter_section(*notch.notch, period);
  const double lowest = std::max(1e-3 * nyquist, 0.05 * notch.notch->frequency_hz);
  std::string rows;
  for (int i = 0; i <= gain_points; ++i) {
    const double hz = lowest * std::pow(nyquist / lowest, static_cast<double>(i) / gain_points);
    const std::complex<double> value =
        response(section, std::min(2.0 * std::numbers::pi * hz * period, std::numbers::pi));
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", hz, decibels(std::abs(value)),
                        std::arg(value) * 180.0 / std::numbers::pi);
  }
  data_block(canvas, "gain", rows);
  canvas.commands(
      axes(fmt::format("set logscale x\nset xrange [{:.6g}:{:.6g}]\nset yrange [*:3]\nset y2tics font ',12'\n"
                       "set ytics nomirror\nset y2range [-90:90]\nset y2tics 30\n"
                       "set y2label 'Phase (degrees, dotted)' font ',12'",
                       lowest, nyquist),
           "Gain of the notch (dB)"));
  x_label(canvas, frame, "Frequency (Hz)");
  canvas.plot(frame,
              fmt::format("$gain using 1:2 with lines {} notitle, $gain using 1:3 axes x1y2 with lines {} notitle",
                          gnuplot_line(with_style), gnuplot_line({"#555555", 1.2, "(2,4)"})));
}

}  // namespace

std::string draw_notch(const Device& device, const NotchOptions& options, const NotchDesign& notch,
                       FigureFormat format) {
  const Units units = units_of(device.parameters().motion);
  const std::string title = "Notch for " + display_name(device);
  std::vector<LegendEntry> legend{
      {fmt::format("without: {} at least", quantity(notch.without, units.stiffness)), without_style}};
  if (const auto& filter = notch.notch) {
    legend.push_back(
        {fmt::format("with a notch at {:.4g} Hz, damping ratio {:.3g}, depth {:.3g}: {} at least", filter->frequency_hz,
                     filter->damping_ratio, filter->depth, quantity(notch.with, units.stiffness)),
         with_style});
  }
  const Heading heading(title, std::move(legend),
                        notch.notch ? std::string() : "No notch was found that makes the worst wall stiffer.");
  const double top = heading.bottom() + 26.0;
  Canvas canvas(title, canvas_width, top + 366.0);
  heading.draw(canvas);
  draw_modal_shifts(canvas, {frame_left, notch.notch ? 440.0 : frame_right, top, top + 304.0},
                    options.modal_frequency_uncertainty, notch, units);
  if (notch.notch)
    draw_gain(canvas, {530.0, frame_right - 46.0, top, top + 304.0}, device.loop().sampling_period, notch);
  return canvas.draw(format);
}

}  // namespace zwidth::report
