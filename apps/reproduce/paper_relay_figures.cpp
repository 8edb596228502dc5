#include "reproduce/paper_relay_figures.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "report/figure/relay_figure.hpp"
#include "report/figure/response_points_figure.hpp"
#include "report/text/quantity.hpp"
#include "reproduce/friction_scan_figure.hpp"
#include "reproduce/paper_devices.hpp"
#include "reproduce/table_2.hpp"
#include "zwidth/stability/bode_points.hpp"

namespace zwidth::report {
namespace {

GainPoints gain_points(std::string name, const std::array<Table2Row, 9>& rows) {
  GainPoints series{std::move(name), {}};
  for (const Table2Row& row : rows) {
    series.points.push_back({2.0 * std::numbers::pi * row.frequency_hz, -row.margin_db});
  }
  return series;
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
  GainPoints printed{"Table II, printed (36 trials)", {}};
  for (const PaperTrial& trial : paper_table_2()) {
    printed.points.push_back({2.0 * std::numbers::pi * trial.frequency_hz, -trial.margin_db});
  }
  const std::string title = "Figure 12: Table II on the response Z[H G_m], both branches";
  return {"figure_12.svg", title,
          fmt::format(
              "The relay settles on one of two branches, by its start: on the slope of -40 dB per decade from {}, on "
              "the resonance from {} at most delays. The rig was on the resonance at 0 and 1 ms and on the slope "
              "from 2 ms on. That all points lie near the curve proves little: whatever the frequency, force and "
              "position of a device at that frequency are related by its response. {}",
              quantity(table.setting.large_start, "m"), quantity(table.setting.small_start, "m"), setting_text(table)),
          draw_response_points(
              title, "Z[H G_m], reduced pretension (inferred)", bode_points(responses.front(), frequencies),
              {std::move(printed),
               gain_points(fmt::format("ours, from {}", quantity(table.setting.large_start, "m")), table.from_large),
               gain_points(fmt::format("ours, from {}", quantity(table.setting.small_start, "m")), table.from_small)},
              FigureFormat::svg)};
}

PaperFigure figure_12_friction() {
  const Table2& table = table_2();
  const std::string title = "The friction that explains Table II";
  return {"figure_12_friction.svg", title,
          fmt::format("Not in the paper: errors of the simulated rows of 2 to 8 ms against the level of Coulomb "
                      "friction, the only number fitted. The frequency alone chooses the level; the margins follow. "
                      "Every point is 28 trials of {:.0f} s with start and friction varied by up to {:.0f} %.",
                      table.setting.duration, 100.0 * table.setting.variation),
          draw_friction_scan(title, table, FigureFormat::svg)};
}

}  // namespace zwidth::report
