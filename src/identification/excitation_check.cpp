#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "zwidth/error.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth {
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

ExcitationCheck check_excitation(const Excitation& excitation, double rate, const Device& device, double stroke_limit) {
  if (!(std::isfinite(rate) && rate > 0.0)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("rate is {}; a frequency in Hz > 0", rate));
  }
  if (!(stroke_limit >= 0.0)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("stroke limit is {}; 0 (none) or more", stroke_limit));
  }
  const DeviceParameters& parameters = device.parameters();
  const bool rotary = parameters.motion == Motion::rotary;
  const std::string_view force_unit = rotary ? "N m" : "N";
  const std::string_view length_unit = rotary ? "rad" : "m";

  ExcitationCheck check;
  check.peak_force = crest_factor(excitation.samples).peak;
  check.peak_stroke = played_stroke(excitation.samples, sample(state_space(device), {1.0 / rate, device.loop().delay}));
  const auto limit = parameters.actuator.force_limit;
  if (limit && check.peak_force > *limit) {
    check.exceeded.push_back({warning,
                              fmt::format("the peak force, {:.4g} {}, is beyond the actuator's limit, {:.4g} {}",
                                          check.peak_force, force_unit, *limit, force_unit),
                              "the actuator would saturate; lower the amplitude"});
  }
  if (stroke_limit > 0.0 && check.peak_stroke > stroke_limit) {
    check.exceeded.push_back({warning,
                              fmt::format("the device moves {:.4g} {} from its start, beyond the stroke of {:.4g} {}",
                                          check.peak_stroke, length_unit, stroke_limit, length_unit),
                              "lower the amplitude, raise the lowest frequency, or lock a body"});
  }
  // Below this many encoder steps of peak motion a record is mostly rounding.
  constexpr double least_steps = 10.0;
  const double resolution = parameters.sensor.resolution;
  if (check.peak_stroke < least_steps * resolution) {
    check.remarks.push_back({warning,
                             fmt::format("the device moves at most {:.4g} {}, {:.2g} steps of its encoder",
                                         check.peak_stroke, length_unit, check.peak_stroke / resolution),
                             "the record would be mostly rounding; raise the amplitude"});
  }
  const bool friction =
      std::any_of(device.bodies().begin(), device.bodies().end(), [](const Body& body) { return body.coulomb > 0.0; });
  if (friction) {
    check.remarks.push_back({Remark::Severity::note, "the stroke is computed without Coulomb friction",
                             "the device moves less than that, or not at all"});
  }
  return check;
}

}  // namespace zwidth
