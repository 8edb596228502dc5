#include "zwidth/stability/device_model.hpp"

#include <utility>

#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth {
using namespace internal;
namespace {

DeviceModel model_of(const Device& device, DiscreteStateSpace discrete, SampledPlant sampled) {
  std::optional<DiscreteStateSpace> with_states;
  if (discrete.delay_samples <= most_delay_states) with_states = with_delay_states(discrete);
  return {device,
          state_space(device),
          std::move(discrete),
          std::move(with_states),
          modal_form(device),
          std::move(sampled),
          device.parameters().wall,
          analyze(device, {.draws = 0}),
          {}};
}

}  // namespace

DeviceModel device_model(const Device& device) {
  const Wall& wall = device.parameters().wall;
  if (!has_damper_loop(device.loop()) || wall.damping == 0.0) {
    const Sampling sampling{device.loop().sampling_period, device.loop().delay};
    return model_of(device, sample(state_space(device), sampling), sampled_plant(device));
  }
  const TwoRateDevice loop(device, wall.damping);
  if (!loop.is_damper_inside()) require_one_rate(device);
  const SampledPlant& plant = loop.seen_by_spring();  // without the filters, which the model's wall has
  DeviceModel model = model_of(device, loop.as_it_runs(device).seen_by_spring(), plant);
  model.wall.damping = 0.0;
  model.wall.velocity_filter_hz = 0.0;
  model.remarks.push_back(damper_closed_at_own_rate(device));
  return model;
}

}  // namespace zwidth
