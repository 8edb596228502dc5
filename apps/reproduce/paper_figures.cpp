#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "report/figure/bode_figure.hpp"
#include "report/figure/device_bode_figure.hpp"
#include "report/figure/figure.hpp"
#include "report/figure/identification_figure.hpp"
#include "report/text/quantity.hpp"
#include "reproduce/paper_devices.hpp"
#include "reproduce/paper_identification.hpp"
#include "reproduce/paper_relay_figures.hpp"
#include "reproduce/reproduction.hpp"

namespace zwidth::report {
namespace {

constexpr std::string_view inferred =
    "Cable of Section IV: k_c = 27.55 kN/m, b_c = 10.5 N s/m, inferred from the printed crossover (set A); the paper "
    "prints neither.";
constexpr std::size_t figure_points = 400;

AnalysedDevice analysed(DeviceParameters parameters) { return analysed_device(Device(std::move(parameters))); }

/// Curves of continuous responses, sharing their frequencies.
void add_curves(BodeFigure& figure, std::span<const DelayedResponse> responses, std::span<const std::string> names,
                std::span<const Mode> modes) {
  const std::vector<double> frequencies = bode_frequencies(responses, figure.range, modes, 0.0, figure_points);
  for (std::size_t i = 0; i < responses.size(); ++i) {
    figure.curves.push_back({names[i], bode_points(responses[i], frequencies)});
  }
}

PaperFigure figure_03() {
  const Device device(paper_lhifam());
  const Loop& loop = device.loop();
  const auto form = [&](std::size_t force_at, std::size_t position_of) {
    return modal_form(device, {force_at, position_of}, ActuatorLag::left_out);
  };
  BodeFigure figure;
  figure.title = "Figure 3: G_d(s), G_c(s) and G_m(s) of LHIfAM (Table I)";
  figure.range = {10.0, 1e4};
  const std::array responses{delayed_response(form(loop.held, loop.held)),
                             delayed_response(form(loop.actuated, loop.held)),
                             delayed_response(form(loop.actuated, loop.actuated))};
  const std::array<std::string, 3> names{"G_d: force and position at the handle",
                                         "G_c: force at one, position of the other",
                                         "G_m: force and position at the motor"};
  add_curves(figure, responses, names, modal_form(device).modes);
  return {"figure_03.svg", figure.title,
          "The three responses of eq. 3, continuous, neither sampled nor delayed. All share the resonance; G_d and G_m "
          "have an antiresonance each, G_c has none.",
          draw(figure, FigureFormat::svg)};
}

/// Figs. 4 and 8: the cable's response and the model fitted to it.
PaperFigure locked_chirp(int number, const DeviceParameters& device, std::string_view cable, std::string_view comment) {
  const PaperChirp chirp;
  const Identification identified = identified_cable(device, chirp);
  const ParameterEstimate& stiffness = identified.fit.estimates[0];
  const ParameterEstimate& damping = identified.fit.estimates[1];
  IdentificationLabels labels;
  labels.title = fmt::format("Figure {}: {}, handle locked (synthetic record)", number, cable);
  labels.points = "synthetic record, with its 95 % band";
  return {
      fmt::format("figure_{:02}.svg", number), labels.title,
      fmt::format(
          "Synthetic: the exact sampled device with its handle locked, played with a chirp ({}), its response "
          "estimated and the cable fitted to it as with a recording. k_c = {:.3f} ± {:.3f} kN/m, b_c = {:.3f} ± {:.3f} "
          "N s/m (95 %). {}",
          paper_chirp_text(chirp, device), 1e-3 * stiffness.value, 1e-3 * (*stiffness.upper - stiffness.value),
          damping.value, *damping.upper - damping.value, comment),
      draw_identification(identified, labels, FigureFormat::svg)};
}

PaperFigure figure_04() {
  return locked_chirp(4, paper_lhifam(), "cable of Table I",
                      "The points of the printed figure are the authors' measurement, which appears in an image only.");
}

PaperFigure figure_08() {
  return locked_chirp(8, paper_lhifam_reduced_pretension(), "cable of reduced pretension", inferred);
}

PaperFigure figure_07() {
  const std::array devices{analysed(paper_lhifam()), analysed(paper_lhifam_rigid())};
  BodeFigure figure = device_bode_figure(devices);
  figure.title = "Figure 7: Z[H G_m] of LHIfAM (Table I) and its margins";
  figure.curves[0].name = "A: Z[H G_m], two bodies, eq. 7";
  figure.curves[1].name = "B: Z[H G], one rigid body, eq. 2";
  return {
      "figure_07.svg", figure.title,
      fmt::format("The printed figure has the first curve only. The margin is that of the rigid-body branch: {:.2f} "
                  "dB with the mode, {:.2f} dB without, close but not equal.",
                  decibels(devices[0].analysis.critical.stiffness), decibels(devices[1].analysis.critical.stiffness)),
      draw(figure, FigureFormat::svg)};
}

PaperFigure figure_09() {
  const std::array devices{analysed(paper_lhifam_reduced_pretension())};
  BodeFigure figure = device_bode_figure(devices);
  figure.title = "Figure 9: Z[H G_m] of LHIfAM with reduced cable pretension";
  figure.notes.emplace_back(inferred);
  return {"figure_09.svg", figure.title, "Now the resonance sets the margin. " + std::string(inferred),
          draw(figure, FigureFormat::svg)};
}

PaperFigure figure_10() {
  const Device device(paper_lhifam_reduced_pretension());
  const ModalForm form = modal_form(device);
  BodeFigure figure;
  figure.title = "Figure 10: G_m(s) e^(-t_d s) for two delays";
  figure.range = {1.0, std::round(std::numbers::pi / device.loop().sampling_period)};
  const std::array responses{delayed_response(form), delayed_response(form, 1e-3), delayed_response(form, 4e-3)};
  const std::array<std::string, 3> names{"no delay", "t_d = 1 ms", "t_d' = 4 ms"};
  add_curves(figure, responses, names, form.modes);
  figure.notes.emplace_back(inferred);
  return {
      "figure_10.svg", figure.title,
      "The paper draws this one as a scheme, without numbers. A delay lowers the phase only. The longer it is, the "
      "earlier the phase passes -180°: on the straight part, of -40 dB per decade, instead of behind the resonance. "
      "The two delays are ours.",
      draw(figure, FigureFormat::svg)};
}

std::string delay_row(double delay, double stiffness_db) {
  return fmt::format("{:.9g} {:.6f}\n", 1e3 * delay, stiffness_db);
}

std::string critical_stiffness_rows(const DeviceParameters& device) {
  constexpr double longest = 8e-3;
  constexpr int steps = 320;
  std::string rows;
  for (int i = 0; i <= steps; ++i) {
    const double delay = longest * i / steps;
    const CriticalStiffness critical = critical_stiffness(filtered_plant(Device(with_delay(device, delay))));
    if (critical.limit) rows += delay_row(delay, decibels(critical.stiffness));
  }
  return rows;
}

PaperFigure figure_10_delays() {
  const std::string title = "Critical stiffness against delay";
  Figure figure{.title = title, .below = 70.0};
  // Offsets: markers must not lie on the frame.
  Panel panel{.height = 320.0,
              .axes = "set ytics 5\nset autoscale xfix\nset offsets graph 0.02, graph 0.02, graph 0.04, graph 0.04",
              .x_label = "Delay (ms), besides the zero-order hold",
              .y_label = "Critical stiffness (dB re 1 N/m)"};
  const auto add = [&](const std::string& name, const LineStyle& style, const DeviceParameters& device) {
    figure.legend.push_back({name, style});
    panel.series.push_back({critical_stiffness_rows(device), as_lines(style)});
  };
  add("Reduced pretension (inferred)", {"#0b4f9e", 2.0, "1"}, paper_lhifam_reduced_pretension());
  add("Table I", {"#c2410c", 1.6, "(10,5)"}, paper_lhifam());
  add("Rigid, eq. 2", {"#15803d", 1.8, "(14,4,3,4)"}, paper_lhifam_rigid());
  std::string trials;
  for (const PaperTrial& trial : paper_table_2()) trials += delay_row(trial.delay, trial.margin_db);
  figure.legend.push_back({"Table II, measured by the relay experiment", {}, {}, ring_marker(ink)});
  panel.series.push_back({trials, as_points(ring_marker(ink))});
  figure.panels = {panel};
  return {
      "figure_10_delays.svg", title,
      "Not in the paper: what Figure 10 argues, computed. The kink is where the limit moves from the resonance to "
      "the rigid body. The measured points stand for comparison: the relay experiment is nonlinear, see Figure 12. " +
          std::string(inferred),
      draw(figure, FigureFormat::svg)};
}

PaperFigure figure_14() {
  const std::array devices{analysed(handle_sensed(paper_lhifam_reduced_pretension()))};
  BodeFigure figure = device_bode_figure(devices);
  figure.title = "Figure 14: Z[H G_c], handle sensed, reduced cable pretension";
  figure.notes.emplace_back(inferred);
  return {"figure_14.svg", figure.title,
          "With the handle sensed the rigid body sets the margin again. " + std::string(inferred),
          draw(figure, FigureFormat::svg)};
}

}  // namespace

std::vector<PaperFigure> paper_figures() {
  constexpr std::array makers{figure_03,        figure_04, figure_07, figure_08,          figure_09, figure_10,
                              figure_10_delays, figure_11, figure_12, figure_12_friction, figure_14};
  std::vector<PaperFigure> figures;
  for (const auto& make : makers) figures.push_back(make());
  return figures;
}

}  // namespace zwidth::report
