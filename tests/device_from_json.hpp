#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "zwidth/model/device.hpp"

namespace zwidth::test {

// A device of the reference data: the device file's form, as JSON.
inline Device device_from_json(const nlohmann::json& json) {
  DeviceParameters parameters;
  parameters.name = json.value("name", "");
  parameters.motion = json.value("motion", "linear") == "rotary" ? Motion::rotary : Motion::linear;
  const auto index = [&parameters](const std::string& name) {
    for (std::size_t i = 0; i < parameters.bodies.size(); ++i)
      if (parameters.bodies[i].name == name) return i;
    throw std::runtime_error("no body " + name);
  };
  for (const auto& body : json.at("body")) {
    parameters.bodies.push_back({body.at("name"), body.at("mass"), body.value("damping", 0.0),
                                 body.value("stiffness", 0.0), body.value("coulomb", 0.0)});
  }
  for (const auto& link : json.value("link", nlohmann::json::array())) {
    parameters.links.push_back({index(link.at("between").at(0)), index(link.at("between").at(1)),
                                link.value("stiffness", 0.0), link.value("damping", 0.0)});
  }
  const auto& loop = json.at("loop");
  parameters.loop = {index(loop.at("actuated")), index(loop.at("sensed")), index(loop.at("held")),
                     loop.at("sampling_period"), loop.value("delay", 0.0)};
  if (json.contains("actuator")) parameters.actuator.time_constant = json["actuator"].value("time_constant", 0.0);
  if (json.contains("wall")) {
    parameters.wall.damping = json["wall"].value("damping", 0.0);
    parameters.wall.velocity_filter_hz = json["wall"].value("velocity_filter_hz", 0.0);
  }
  if (json.contains("operator")) {
    const auto& user = json["operator"];
    parameters.user = {user.value("mass", 0.0), user.value("damping", 0.0), user.value("stiffness", 0.0)};
  }
  return Device(parameters);
}

}  // namespace zwidth::test
