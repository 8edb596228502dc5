#include "reproduce/paper_relay_figures.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/quantity.hpp"
#include "reproduce/paper_devices.hpp"
#include "reproduce/table_2.hpp"
#include "zwidth/stability/bode_points.hpp"

namespace zwidth::report {
namespace {

std::string gain_row(double frequency_hz, double gain_db) {
  return fmt::format("{:.9g} {:.6f}\n", frequency_hz, gain_db);
}

std::string relay_rows(const std::array<Table2Row, 9>& trials) {
  std::string rows;
  for (const Table2Row& each : trials) rows += gain_row(each.frequency_hz, -each.margin_db);
  return rows;
}

std::string setting_text(const Table2& table) {
  return fmt::format(
      "Simulated with the inferred cable (set A), Coulomb friction of the handle of {:.3g} of the relay's force, the "
      "encoder of 3.14 µm and {} besides the stated delay.",
      table.friction_level, quantity(table.setting.inherent_delay, "s"));
}

}  // namespace

PaperFigure figure_11() {
  const Table2& table = table_2();
  const std::string title = "Figure 11: force and position of a relay experiment, t_d = 0";
  return {
      "figure_11.svg", title,
      fmt::format("Both signals in opposite phase, as in the paper, which prints no scales. The relay's force of {} "
                  "is ours; it sets the scale of the position only. {}",
                  quantity(table.setting.relay_force, "N"), setting_text(table)),
      draw_relay_record(title, table.first_trial, 1e-3, Motion::linear, FigureFormat::svg)};
}

PaperFigure figure_12() {
  const Table2& table = table_2();
  const Device device(paper_lhifam_reduced_pretension());
  const std::array responses{delayed_response(filtered_plant(device))};
  constexpr FrequencyRange range{2.0 * std::numbers::pi, 2.0 * std::numbers::pi * 100.0};
  const std::vector<double> frequencies = bode_frequencies(responses, range, modal_form(device).modes, 1e-3, 400);
  std::string curve;
  for (const BodePoint& point : bode_points(responses.front(), frequencies)) {
    curve += gain_row(hertz(point.frequency), point.magnitude_db);
  }
  std::string printed;
  for (const PaperTrial& trial : paper_table_2()) printed += gain_row(trial.frequency_hz, -trial.margin_db);
  const std::string title = "Figure 12: Table II on the response Z[H G_m], both branches";
  constexpr LineStyle response_line{"#555555", 1.4, "1"};
  Figure figure{.title = title, .legend = {{"Z[H G_m], reduced pretension (inferred)", response_line}}, .below = 70.0};
  Panel panel{.above = 22.0,
              .height = 360.0,
              .axes = fmt::format("set grid mxtics\nset logscale x\nset mxtics 10\nset format x '%g'\n"
                                  "set xrange [{:.9g}:{:.9g}]",
                                  hertz(frequencies.front()), hertz(frequencies.back())),
              .x_label = "Frequency (Hz)",
              .y_label = "Position over force (dB re 1 m/N)",
              .series = {{curve, as_lines(response_line)}}};
  // Told apart by shape as well as by colour.
  const auto add = [&](const std::string& name, const std::string& rows, int type, std::string_view colour) {
    figure.legend.push_back({name, {}, {}, fmt::format("pt {} ps 0.8 lw 1.4 lc rgb '{}'", type, colour)});
    panel.series.push_back({rows, as_points(figure.legend.back().marker)});
  };
  add("Table II, printed (36 trials)", printed, 6, blue);
  add(fmt::format("ours, from {}", quantity(table.setting.large_start, "m")), relay_rows(table.from_large), 7, orange);
  add(fmt::format("ours, from {}", quantity(table.setting.small_start, "m")), relay_rows(table.from_small), 9, green);
  figure.panels = {panel};
  return {"figure_12.svg", title,
          fmt::format(
              "The relay settles on one of two branches, by its start: on the slope of -40 dB per decade from {}, on "
              "the resonance from {} at most delays. The rig was on the resonance at 0 and 1 ms and on the slope "
              "from 2 ms on. That all points lie near the curve proves little: whatever the frequency, force and "
              "position of a device at that frequency are related by its response. {}",
              quantity(table.setting.large_start, "m"), quantity(table.setting.small_start, "m"), setting_text(table)),
          draw(figure, FigureFormat::svg)};
}

PaperFigure figure_12_friction() {
  const Table2& table = table_2();
  const std::string title = "The friction that explains Table II";
  const double low = table.friction_scan.front().level;
  const double high = table.friction_scan.back().level;
  std::string rows;
  for (const FrictionTrial& trial : table.friction_scan) {
    rows += fmt::format("{:.6g} {:.6g} {:.6g}\n", trial.level, 100.0 * trial.error.frequency, trial.error.margin_db);
  }
  const std::string look = fmt::format("linespoints pt 7 ps 0.5 {}", gnuplot_line({"#0b4f9e", 1.8, "1"}));
  const auto mark_chosen = [&](Canvas& canvas, const Box& frame) {
    constexpr LineStyle chosen{"#b91c1c", 1.2, "(6,4)"};
    const double x = frame.left + (frame.right - frame.left) * (table.friction_level - low) / (high - low);
    canvas.text(x + 8.0, frame.top + 14.0, fmt::format("chosen: {:.4g}", table.friction_level),
                {Anchor::left, 12.0, chosen.colour});
    canvas.line(x, frame.top, x, frame.bottom + 168.0, chosen);
  };
  const Panel frequency{.above = 20.0,
                        .height = 180.0,
                        .axes = fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [0:*]\nset format x ''", low, high),
                        .y_label = "Frequency, rms (%)",
                        .series = {{rows, look}},
                        .marks = mark_chosen};
  const Panel margin{.above = 28.0,
                     .height = 140.0,
                     .axes = "set format x '%g'",
                     .x_label = "Friction of the handle over the relay's force, F_c/d",
                     .y_label = "Margin, rms (dB)",
                     .series = {{rows, look, "1:3"}}};
  return {"figure_12_friction.svg", title,
          fmt::format("Not in the paper: errors of the simulated rows of 2 to 8 ms against the level of Coulomb "
                      "friction, the only number fitted. The frequency alone chooses the level; the margins follow. "
                      "Every point is 28 trials of {:.0f} s with start and friction varied by up to {:.0f} %.",
                      table.setting.duration, 100.0 * table.setting.variation),
          draw(Figure{.title = title, .panels = {frequency, margin}, .below = 68.0}, FigureFormat::svg)};
}

}  // namespace zwidth::report
