#pragma once

// The devices of reference/two_rates.json, whose spring and damper run at two rates.

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "zwidth/model/device.hpp"

namespace zwidth::test {

inline nlohmann::json two_rate_cases() {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/two_rates.json");
  return nlohmann::json::parse(file);
}

inline DeviceParameters two_rate_parameters(const nlohmann::json& json) {
  DeviceParameters parameters;
  parameters.name = json.at("name");
  for (const auto& body : json.at("bodies")) {
    parameters.bodies.push_back({"body " + std::to_string(parameters.bodies.size()), body[0], body[1], 0.0, 0.0});
  }
  for (const auto& link : json.at("links")) parameters.links.push_back({link[0], link[1], link[2], link[3]});
  const auto& spring = json.at("spring");
  parameters.loop.held = parameters.bodies.size() - 1;
  parameters.loop.sampling_period = spring.at("sampling_period");
  parameters.loop.delay = spring.at("delay");
  const auto& damper = json.at("damper");
  parameters.loop.damper = LoopDamper{damper.at("sampling_period").get<double>(), damper.at("delay").get<double>()};
  parameters.wall.damping = damper.at("damping");
  parameters.wall.velocity_filter_hz = damper.at("velocity_filter_hz");
  return parameters;
}

}  // namespace zwidth::test
