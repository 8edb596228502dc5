#include "report/figure/rig_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "report/figure/figures.hpp"
#include "report/figure/identification_figure.hpp"
#include "report/figure/record_figure.hpp"
#include "report/output_file.hpp"
#include "report/text/quantity.hpp"
#include "results/frf_json.hpp"

namespace zwidth::report {
namespace {

void require(bool has_figure, std::string_view what) {
  if (!has_figure) throw OutputFailed(fmt::format("there is nothing to draw: {}", what));
}

}  // namespace

std::string draw_rig(const Device& device, const RigMeasurement& measurement, FigureFormat format) {
  require(measurement.response.has_value(), "no response was measured");
  return draw_frf(*measurement.response, results::frf_units(device), format);
}

std::string draw_rig(const Device& /*device*/, const RigIdentification& identified, FigureFormat format) {
  require(identified.identification.has_value(), "nothing was identified");
  return draw_identification(*identified.identification, format);
}

std::string draw_rig(const Device& /*device*/, const RigRelay& found, FigureFormat format) {
  require(found.relay.has_value(), "no trial came to its end");
  return draw_relay(*found.relay, format);
}

bool has_figure(const RigWall& wall) {
  return !wall.recording.channels.empty() && !wall.recording.channels[0].samples.empty();
}

std::string draw_rig(const Device& device, const RigWall& wall, FigureFormat format) {
  require(has_figure(wall), "no cycle was recorded");
  const Units units = units_of(device.parameters().motion);
  return draw_record("Wall on the rig: " + device.name(),
                     fmt::format("K = {}, B = {}", quantity(wall.controller.stiffness, units.stiffness),
                                 quantity(wall.controller.damping, units.damping)),
                     {.force = wall.recording.channels[0].samples,
                      .position = wall.recording.channels[1].samples,
                      .sampling_period = device.loop().sampling_period,
                      .motion = device.parameters().motion},
                     format);
}

bool has_figure(const RigLimit& limit) {
  return std::ranges::any_of(limit.measured.trials, [](const LimitTrial& trial) { return trial.ring.has_value(); });
}

std::string draw_rig(const Device& device, const RigLimit& limit, FigureFormat format) {
  require(has_figure(limit), "no oscillation was read");
  return draw_limit_trials(device, limit, format);
}

}  // namespace zwidth::report
