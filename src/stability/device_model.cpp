#include "zwidth/stability/device_model.hpp"

#include <utility>

#include "zwidth/model/damper_timing.hpp"

namespace zwidth {

DeviceModel device_model(const Device& device) {
  require_one_rate(device);
  ContinuousStateSpace continuous = state_space(device);
  DiscreteStateSpace discrete = sample(continuous, {device.loop().sampling_period, device.loop().delay});
  std::optional<DiscreteStateSpace> with_states;
  if (discrete.delay_samples <= most_delay_states) with_states = with_delay_states(discrete);
  return {device,
          std::move(continuous),
          std::move(discrete),
          std::move(with_states),
          modal_form(device),
          sampled_plant(device),
          analyze(device, limit_and_wall_only())};
}

}  // namespace zwidth
