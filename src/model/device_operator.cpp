#include "zwidth/model/device_operator.hpp"

#include <utility>

namespace zwidth {

bool has_operator(const Device& device) {
  const Operator& user = device.parameters().user;
  return user.mass > 0.0 || user.damping > 0.0 || user.stiffness > 0.0;
}

Device with_operator(const Device& device, const Operator& user) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  parameters.user = user;
  return Device(std::move(parameters));
}

Device without_operator(const Device& device) { return with_operator(device, {}); }

}  // namespace zwidth
