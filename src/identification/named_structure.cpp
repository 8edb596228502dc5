#include <map>

#include "zwidth/identification/identification.hpp"

namespace zwidth {

std::optional<DeviceParameters> named_structure(std::string_view name, Motion motion, double sampling_period) {
  static const std::map<std::string_view, std::vector<std::string>> bodies{
      {"rigid", {"body"}}, {"two-body", {"motor", "handle"}}, {"three-body", {"motor", "body", "handle"}}};
  const auto named = bodies.find(name);
  if (named == bodies.end()) return std::nullopt;
  DeviceParameters device;
  device.name = name;
  device.motion = motion;
  for (const std::string& body : named->second) {
    if (!device.bodies.empty()) device.links.push_back({device.bodies.size() - 1, device.bodies.size(), 1.0, 1.0});
    device.bodies.push_back({body, 1.0, 1.0, 0.0, 0.0});
  }
  device.loop.held = device.bodies.size() - 1;
  device.loop.sampling_period = sampling_period;
  return device;
}

}  // namespace zwidth
