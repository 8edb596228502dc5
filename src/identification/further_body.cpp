#include "identification/further_body.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "identification/model/rivals/rival.hpp"
#include "identification/model/segment_player.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

std::string free_name(const DeviceParameters& device) {
  std::string name = "further";
  while (std::ranges::find(device.bodies, name, &Body::name) != device.bodies.end()) name += "_body";
  return name;
}

/// The further body against the held one alone.
struct Swing {
  double frequency = 0.0;  ///< rad/s
  double damping_ratio = 0.0;
};

Swing swing_of(const DeviceParameters& device) {
  const Link& link = device.links.back();
  const double further = device.bodies.back().mass;
  const double held = device.bodies[link.first].mass;
  const double reduced = further * held / (further + held);
  const double frequency = std::sqrt(link.stiffness / reduced);
  return {frequency, link.damping / (2.0 * reduced * frequency)};
}

}  // namespace

std::optional<FurtherBody> with_further_body(const Device& structure, const FreeNumbers& free,
                                             const FrequencyResponse& response) {
  constexpr double share = 0.1;  // of the held body's mass; where no line tells, a search begins here
  constexpr double damping_ratio = 0.01;
  DeviceParameters device = structure.parameters();
  if (device_has_user(structure) || device.transfer_function || device.bodies.size() >= SegmentPlayer::most_bodies ||
      response.points.empty())
    return std::nullopt;
  if (!moving_held_body({.device = device, .locked = free.locked})) return std::nullopt;
  const Body& held = device.bodies[device.loop.held];
  FreeNumbers with = free;
  with.is_start = false;
  with.is_known = false;
  for (std::string& key : with.keys) {  // "link.stiffness" names a link while there is one
    if (key != "all") key = full_parameter_key(device, key);
  }
  const std::string body = "body." + free_name(device);
  const std::string link = "link." + std::to_string(device.links.size());
  if (!frees_all(free.keys)) {
    for (const std::string& key : {body + ".mass", body + ".damping", link + ".stiffness", link + ".damping"})
      with.keys.push_back(key);
  }
  const double mass = share * held.mass;
  const double frequency = std::sqrt(response.points.front().frequency * response.points.back().frequency);
  device.links.push_back(
      {device.loop.held, device.bodies.size(), mass * frequency * frequency, 2.0 * damping_ratio * mass * frequency});
  device.bodies.push_back({.name = free_name(device), .mass = mass});
  device.uncertainty.reset();
  return FurtherBody{Device(std::move(device)), std::move(with)};
}

bool is_mode(const DeviceParameters& device, const FrequencyResponse& response) {
  constexpr double most_damping_ratio = 0.5;
  const Swing swing = swing_of(device);
  return swing.damping_ratio < most_damping_ratio && swing.frequency > response.points.front().frequency &&
         swing.frequency < response.points.back().frequency;
}

Finding further_body_fitted(const DeviceParameters& device) {
  const Body& body = device.bodies.back();
  const std::string& behind = device.bodies[device.links.back().first].name;
  return {.code = FindingCode::further_body_fitted,
          .evidence = {{"mass", body.mass}, {"frequency", hertz(swing_of(device).frequency), "Hz"}},
          .subjects = {{"body", body.name},
                       {"behind", behind},
                       {"unit", device.motion == Motion::rotary ? "kg m^2" : "kg"}},
          .key = "body." + body.name + ".mass"};
}

}  // namespace zwidth::internal
