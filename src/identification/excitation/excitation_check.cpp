#include "identification/excitation/excitation_check.hpp"

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
    check.exceeded.push_back(warning({.code = FindingCode::excitation_beyond_force_limit,
                                      .evidence = {{"force", check.peak_force}, {"limit", *limit}},
                                      .subjects = {{"unit", std::string(units.force)}},
                                      .key = "actuator.force_limit"}));
  }
  const auto stroke = excitation.options.stroke_limit;
  if (stroke && check.peak_stroke > *stroke) {
    check.exceeded.push_back(warning({.code = FindingCode::excitation_beyond_stroke,
                                      .evidence = {{"stroke", check.peak_stroke}, {"limit", *stroke}},
                                      .subjects = {{"unit", std::string(units.length)}}}));
  }
  // Below this many encoder steps of peak motion a record is mostly rounding.
  constexpr double least_steps = 10.0;
  const double resolution = parameters.sensor.resolution;
  if (check.peak_stroke < least_steps * resolution) {
    check.remarks.push_back(warning({.code = FindingCode::excitation_moves_few_steps,
                                     .evidence = {{"stroke", check.peak_stroke},
                                                  {"steps", check.peak_stroke / resolution},
                                                  {"threshold", least_steps}},
                                     .subjects = {{"unit", std::string(units.length)}},
                                     .key = "sensor.resolution"}));
  }
  if (const Trust trust = trust_of(device); !trust.sound()) {
    check.remarks.push_back(warning({.code = FindingCode::excitation_of_doubtful_device,
                                     .subjects = {{"reason", fmt::format("{}", fmt::join(trust.reasons, "; "))}}}));
  }
  const bool friction =
      std::any_of(device.bodies().begin(), device.bodies().end(), [](const Body& body) { return body.coulomb > 0.0; });
  if (friction) {
    check.remarks.push_back(note({.code = FindingCode::stroke_without_friction}));
  }
  return check;
}

}  // namespace zwidth::internal
