#include <algorithm>
#include <cmath>
#include <numbers>

#include "design/sensitivities/controller_sensitivity.hpp"
#include "design/sensitivities/coordinate_sensitivity.hpp"
#include "design/sensitivities/design_parameter.hpp"
#include "design/sensitivities/plant_sensitivity.hpp"
#include "design/sensitivities/two_rate_sensitivity.hpp"
#include "stability/limit/gain_locus.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Complex = std::complex<double>;

constexpr double same_stiffness = 1e-6;  // relative, of a crossover handed in and the loop's own K there

std::vector<Sensitivity> at_crossover(const Device& device, const SampledPlant& unfiltered, const Crossover& limit) {
  const double nyquist = std::numbers::pi / device.loop().sampling_period;
  const bool is_real = limit.frequency == 0.0 || limit.frequency >= nyquist;  // z = 1 or -1: the angle stays
  const double angle = limit.frequency >= nyquist ? std::numbers::pi : limit.frequency * device.loop().sampling_period;
  const std::vector<DesignParameter> parameters = design_parameters(device);
  const PlantSensitivity plant = plant_sensitivity(device, angle, parameters, response(unfiltered, limit.frequency));
  const FilterSensitivity filters = filter_sensitivity(device, angle, parameters);
  const DamperSensitivity damper = damper_sensitivity(device, angle, parameters);
  // L = -1/(F P) - B v
  const Complex open = -1.0 / (filters.value * plant.value);
  const Complex stiffness = open - damper.value;
  const double same = same_stiffness * (limit.stiffness + std::abs(open));
  if (!(std::abs(stiffness.real() - limit.stiffness) <= same)) {
    // Beside the pole of a mode that hardly anything damps no double is near enough: no slope is sure.
    const Wall& wall = device.parameters().wall;
    const FilteredPlant seen = filtered_plant(unfiltered, wall.filters);
    const GainLocus locus(seen, GainLocus::Gain::stiffness, 0.0, {wall.damping, wall.velocity_filter_hz});
    if (!(locus.by_terms(angle).gain_noise() <= same)) return {};
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::other_devices_limit});
  }
  const Complex by_angle = -open * (filters.log_by_angle + plant.by_angle / plant.value) - damper.by_angle;
  const double along = is_real ? 0.0 : by_angle.real() / by_angle.imag();
  std::vector<Sensitivity> result;
  result.reserve(parameters.size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Complex slope =
        -open * (filters.log_by_parameter[i] + plant.by_parameter[i] / plant.value) - damper.by_parameter[i];
    const double by_parameter = slope.real() - along * slope.imag();
    if (!std::isfinite(by_parameter)) continue;
    const double value = parameters[i].value;
    result.push_back({parameters[i].key, value, by_parameter,
                      value != 0.0 ? std::optional(value / limit.stiffness * by_parameter) : std::nullopt});
  }
  return result;
}

}  // namespace

std::vector<Sensitivity> stiffness_sensitivities(const Device& device) {
  if (has_damper_loop(device.loop())) return stiffness_sensitivities(device, unguarded_stiffness(device));
  if (device.parameters().coordinates) return stiffness_sensitivities(device, critical_stiffness(device));
  const Wall& wall = device.parameters().wall;
  const SampledPlant plant = sampled_plant(device);
  const CriticalStiffness critical =
      critical_stiffness(filtered_plant(plant, wall.filters), {wall.damping, wall.velocity_filter_hz});
  return critical.limit ? at_crossover(device, plant, *critical.limit) : std::vector<Sensitivity>{};
}

std::vector<Sensitivity> stiffness_sensitivities(const Device& device, const CriticalStiffness& critical) {
  if (has_damper_loop(device.loop())) {
    if (!critical.limit) return {};
    if (device.parameters().wall.damping == 0.0) return stiffness_sensitivities(with_one_rate(device), critical);
    return two_rate_sensitivities(device, *critical.limit);
  }
  if (!critical.limit) return {};
  if (device.parameters().coordinates) return coordinate_sensitivities(device, *critical.limit);
  return at_crossover(device, sampled_plant(device), *critical.limit);
}

}  // namespace zwidth
