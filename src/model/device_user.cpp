#include "zwidth/model/device_user.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace zwidth {

bool device_has_user(const Device& device) {
  const User& user = device.parameters().user;
  return user.mass > 0.0 || user.damping > 0.0 || user.stiffness > 0.0;
}

Device device_with_user(const Device& device, const User& user) {
  DeviceParameters parameters = device.parameters();
  parameters.user = user;
  std::optional<Uncertainty>& known = parameters.uncertainty;
  const auto is_of_user = [](const std::string& key) { return key.starts_with("operator."); };
  if (known && std::ranges::any_of(known->parameters, is_of_user)) {
    known->parameters.clear();
    known->covariance.clear();
  }
  return Device(std::move(parameters));
}

Device device_without_user(const Device& device) { return device_with_user(device, {}); }

}  // namespace zwidth
