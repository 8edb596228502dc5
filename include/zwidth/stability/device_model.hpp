#pragma once

#include <cstddef>
#include <optional>

#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {

/// A longer delay has no states of its own: the matrix would be mostly zeros.
inline constexpr std::size_t most_delay_states = 200;

/// Everything about a device that another program needs to go on from.
struct DeviceModel {
  Device device;                                        ///< that the models are of
  ContinuousStateSpace continuous;                      ///< from the actuator's force to the sensed position
  DiscreteStateSpace discrete;                          ///< with hold, delay and the wall's filters
  std::optional<DiscreteStateSpace> with_delay_states;  ///< absent beyond most_delay_states samples of delay
  ModalForm modal;                                      ///< as a sum of modes
  SampledPlant sampled;                                 ///< without the wall's filters
  Analysis analysis;                                    ///< the critical stiffness, the modes and the wall's margins
};

/// The continuous model of a device, the exact discrete ones and its critical stiffness. Throws as analyze() does.
[[nodiscard]] DeviceModel device_model(const Device& device);

}  // namespace zwidth
