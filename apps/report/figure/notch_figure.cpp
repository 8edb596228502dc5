#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "zwidth/design/notch_design.hpp"

namespace zwidth::report {
namespace {

constexpr LineStyle without_style{"#c2410c", 1.8, "(10,5)"};
constexpr LineStyle with_style{"#0b4f9e", 2.2, "1"};
constexpr int plotted_gains = 400;

Panel modal_shift_panel(double uncertainty, const NotchDesign& notch, const Units& units) {
  std::string rows;
  double top = 0.0;
  for (const NotchAtModalShift& each : notch.over_modal_shift) {
    for (const double limit : {each.without, each.with}) {
      if (std::isfinite(limit)) top = std::max(top, limit);
    }
  }
  if (top == 0.0) top = 1.0;  // no wall keeps the margins: a line at 0
  const AxisUnit unit = axis_unit(top);
  for (const NotchAtModalShift& each : notch.over_modal_shift) {
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", 100.0 * each.modal_shift, each.without / unit.size,
                        each.with / unit.size);
  }
  const double reach = std::max(100.0 * uncertainty, 1.0);
  const std::string style = notch.over_modal_shift.size() > 1 ? "lines " : "points pt 7 ";
  Panel panel{
      .height = 304.0,
      .right = notch.notch ? 440.0 : frame_right,
      .axes = fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [0:{:.6g}]", -reach, reach, 1.1 * top / unit.size),
      .x_label = "Shift of the modes (%)",
      .y_label = fmt::format("Stiffest wall ({}{})", unit.prefix, units.stiffness),
      .series = {{rows, style + gnuplot_line(without_style)}}};
  if (notch.notch) panel.series.push_back({std::nullopt, style + gnuplot_line(with_style), "1:3"});
  return panel;
}

Panel gain_panel(double period, const NotchDesign& notch) {
  const double nyquist = 0.5 / period;
  const FilterSection section = filter_section(*notch.notch, period);
  const double lowest = std::max(1e-3 * nyquist, 0.05 * notch.notch->frequency_hz);
  std::string rows;
  for (int i = 0; i <= plotted_gains; ++i) {
    const double hz = lowest * std::pow(nyquist / lowest, static_cast<double>(i) / plotted_gains);
    const std::complex<double> value =
        response(section, std::min(2.0 * std::numbers::pi * hz * period, std::numbers::pi));
    rows += fmt::format("{:.9g} {:.9g} {:.9g}\n", hz, decibels(std::abs(value)),
                        std::arg(value) * 180.0 / std::numbers::pi);
  }
  return {
      .height = 304.0,
      .left = 530.0,
      .right = frame_right - 46.0,
      .is_beside = true,
      .axes = fmt::format("set logscale x\nset xrange [{:.6g}:{:.6g}]\nset yrange [*:3]\nset y2tics font ',12'\n"
                          "set ytics nomirror\nset y2range [-90:90]\nset y2tics 30\n"
                          "set y2label 'Phase (degrees, dotted)' font ',12'",
                          lowest, nyquist),
      .x_label = "Frequency (Hz)",
      .y_label = "Gain of the notch (dB)",
      .series = {{rows, as_lines(with_style)}, {std::nullopt, as_lines({"#555555", 1.2, "(2,4)"}), "1:3 axes x1y2"}}};
}

}  // namespace

std::string draw_notch(const Device& device, const NotchOptions& options, const NotchDesign& notch,
                       FigureFormat format) {
  const Units units = units_of(device.parameters().motion);
  Figure figure{
      .title = "Notch for " + display_name(device),
      .subtitle = notch.notch ? "" : "No notch was found that makes the worst wall stiffer.",
      .legend = {{fmt::format("without: {} at least", quantity(notch.without, units.stiffness)), without_style}},
      .panels = {modal_shift_panel(options.modal_frequency_uncertainty, notch, units)}};
  if (const auto& filter = notch.notch) {
    figure.legend.push_back(
        {fmt::format("with a notch at {:.4g} Hz, damping ratio {:.3g}, depth {:.3g}: {} at least", filter->frequency_hz,
                     filter->damping_ratio, filter->depth, quantity(notch.with, units.stiffness)),
         with_style});
    figure.panels.push_back(gain_panel(device.loop().sampling_period, notch));
  }
  return draw(figure, format);
}

}  // namespace zwidth::report
