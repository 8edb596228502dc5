#include "report/page/rig_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "report/figure/figures.hpp"
#include "report/figure/identification_figure.hpp"
#include "report/figure/record_figure.hpp"
#include "report/page/answer_box.hpp"
#include "report/page/html_page.hpp"
#include "report/text/quantity.hpp"
#include "report/text/rig_text.hpp"
#include "results/frf_json.hpp"

namespace zwidth::report {
namespace {

template <typename Result>
std::string page(std::string_view action, const Device& device, const Result& result, const std::string& figures = "") {
  const std::string title = fmt::format("Rig {}: {}", action, device.name());
  return html_page(title, element("h1", title) + html_lines(rig_text(device, result)) + figures +
                              element("h2", "What the device's file says") + answer_box(analysed_device(device)));
}

std::string response_figure(const Device& device, const RigMeasurement& measurement) {
  if (!measurement.response) return "";
  return html_figure(draw_frf(*measurement.response, results::frf_units(device), FigureFormat::svg), "response",
                     "Measured from the commanded force to the position, with 95 % bands.");
}

}  // namespace

std::string rig_page(const Device& device, const RigCheck& check) { return page("check", device, check); }

std::string rig_page(const Device& device, const RigMeasurement& measurement) {
  return page("measure", device, measurement, response_figure(device, measurement));
}

std::string rig_page(const Device& device, const RigIdentification& found) {
  std::string figures = response_figure(device, found.measurement);
  if (found.identification) {
    figures += html_figure(draw_identification(*found.identification, FigureFormat::svg), "fit",
                           "The fitted device over what was measured.");
  }
  return page("identify", device, found, figures);
}

std::string rig_page(const Device& device, const RigRelay& found) {
  std::string figures;
  if (found.relay) {
    figures = html_figure(draw_relay(*found.relay, FigureFormat::svg), "relay",
                          "The end of the first trial that oscillates: force of the relay, and position.");
  }
  return page("relay", device, found, figures);
}

std::string rig_page(const Device& device, const RigWall& wall) {
  std::string figures;
  if (!wall.recording.channels.empty() && !wall.recording.channels[0].samples.empty()) {
    const Units units = units_of(device.parameters().motion);
    figures =
        html_figure(draw_record("Wall on the rig: " + device.name(),
                                fmt::format("K = {}, B = {}", quantity(wall.controller.stiffness, units.stiffness),
                                            quantity(wall.controller.damping, units.damping)),
                                {.force = wall.recording.channels[0].samples,
                                 .position = wall.recording.channels[1].samples,
                                 .sampling_period = device.loop().sampling_period,
                                 .motion = device.parameters().motion},
                                FigureFormat::svg),
                    "wall", "Force that was sent, and position as sensed, from the first cycle.");
  }
  return page("wall", device, wall, figures);
}

std::string rig_page(const Device& device, const RigLimit& limit) {
  std::string figures;
  const auto is_read = [](const LimitTrial& trial) { return trial.ring.has_value(); };
  if (std::ranges::any_of(limit.measured.trials, is_read)) {
    figures = html_figure(draw_limit_trials(device, limit, FigureFormat::svg), "limit",
                          "Below the grey line the oscillation after a knock decays: the wall is stable. Where the "
                          "growth passes through zero is the critical stiffness of the device on the rig.");
  }
  return page("limit", device, limit, figures);
}

}  // namespace zwidth::report
