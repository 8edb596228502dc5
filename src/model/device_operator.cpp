#include "zwidth/model/device_operator.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace zwidth {

bool has_operator(const Device& device) {
  const Operator& user = device.parameters().user;
  return user.mass > 0.0 || user.damping > 0.0 || user.stiffness > 0.0;
}

Device with_operator(const Device& device, const Operator& user) {
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

Device without_operator(const Device& device) { return with_operator(device, {}); }

}  // namespace zwidth
