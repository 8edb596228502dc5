#include "identification/excitation_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth::internal {
namespace {

constexpr auto warning = Remark::Severity::warning;

/// Largest excursion of the sensed body; infinite where it runs away beyond all numbers.
double played_stroke(const std::vector<double>& force, DiscreteStateSpace system) {
  ForcedMotion motion(std::move(system));
  double stroke = 0.0;
  for (const double each : force) {
    const double excursion = std::abs(motion.step(each));
    if (!std::isfinite(excursion)) return std::numeric_limits<double>::infinity();
    stroke = std::max(stroke, excursion);
  }
  return stroke;
}

}  // namespace

ExcitationCheck check_excitation(const Excitation& excitation, const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  const Units units = units_of(parameters.motion);
  const double period = 1.0 / excitation.rate;
  ExcitationCheck check;
  check.device = device.name();
  check.peak_force = excitation.crest.peak;
  check.peak_stroke = played_stroke(excitation.samples, sample(state_space(device), {period, device.loop().delay}));
  const auto limit = parameters.actuator.force_limit;
  if (limit && check.peak_force > *limit) {
    check.exceeded.push_back({warning,
                              fmt::format("the peak force, {:.4g} {}, is beyond the actuator's limit, {:.4g} {}",
                                          check.peak_force, units.force, *limit, units.force),
                              "the actuator would saturate; lower the amplitude"});
  }
  const auto stroke = excitation.options.stroke_limit;
  if (stroke && check.peak_stroke > *stroke) {
    check.exceeded.push_back({warning,
                              fmt::format("the device moves {:.4g} {} from its start, beyond the stroke of {:.4g} {}",
                                          check.peak_stroke, units.length, *stroke, units.length),
                              "lower the amplitude, raise the lowest frequency, or lock a body"});
  }
  // Below this many encoder steps of peak motion a record is mostly rounding.
  constexpr double least_steps = 10.0;
  const double resolution = parameters.sensor.resolution;
  if (check.peak_stroke < least_steps * resolution) {
    check.remarks.push_back({warning,
                             fmt::format("the device moves at most {:.4g} {}, {:.2g} steps of its encoder",
                                         check.peak_stroke, units.length, check.peak_stroke / resolution),
                             "the record would be mostly rounding; raise the amplitude"});
  }
  if (const Trust trust = trust_of(device); !trust.sound()) {
    check.remarks.push_back(
        {warning, fmt::format("the device's file is not to be relied on: {}", fmt::join(trust.reasons, "; ")),
         "the stroke may be another; begin with less force"});
  }
  const bool friction =
      std::any_of(device.bodies().begin(), device.bodies().end(), [](const Body& body) { return body.coulomb > 0.0; });
  if (friction) {
    check.remarks.push_back({Remark::Severity::note, "the stroke is computed without Coulomb friction",
                             "the device moves less than that, or not at all"});
  }
  return check;
}

}  // namespace zwidth::internal
