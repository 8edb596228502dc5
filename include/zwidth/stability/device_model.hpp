#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {

/// A longer delay has no states of its own: the matrix would be mostly zeros.
inline constexpr std::size_t most_delay_states = 200;

/// Everything about a device that another program needs to go on from. With a faster damper in a loop of its own `discrete`,
/// `with_delay_states` and `sampled` are the plant that the spring sees, that damper closed: the states are the device's, then
/// the damper's last position, its low-pass, and what of both forces is on its way. A remark says so.
struct DeviceModel {
  Device device;                                        ///< that the models are of
  ContinuousStateSpace continuous;                      ///< from the actuator's force to the sensed position
  DiscreteStateSpace discrete;                          ///< with hold, delay and the wall's filters
  std::optional<DiscreteStateSpace> with_delay_states;  ///< absent beyond most_delay_states samples of delay
  ModalForm modal;                                      ///< as a sum of modes
  SampledPlant sampled;                                 ///< without the wall's filters
  Wall wall;                                            ///< what closes the loop of the discrete ones
  Analysis analysis;                                    ///< the limits with each user, the modes and the wall's margins
  std::vector<Remark> remarks = {};                     ///< what else the models are of
};

/// The continuous model of a device, the exact discrete ones and its critical stiffness. Throws as analyze() does, and Error
/// (invalid_argument) for a damper that runs slower than the spring.
[[nodiscard]] DeviceModel device_model(const Device& device);

}  // namespace zwidth
