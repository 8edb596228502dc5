#include "design/sensitivities/design_parameter.hpp"

#include <fmt/format.h>

#include "model/key_members.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

using Kind = DesignParameter::Kind;

void add_filter(const WallFilter& filter, std::size_t index, std::vector<DesignParameter>& parameters) {
  const auto add = [&](Kind kind, const char* name, double value) {
    if (is_number_of(filter, name))
      parameters.push_back({kind, index, fmt::format("wall.filter.{}.{}", index, name), value});
  };
  add(Kind::filter_frequency_hz, "frequency_hz", filter.frequency_hz);
  add(Kind::filter_damping_ratio, "damping_ratio", filter.damping_ratio);
  add(Kind::filter_depth, "depth", filter.depth);
  add(Kind::filter_ratio, "ratio", filter.ratio);
}

// Springs that are not there are left out: one at every joint would be no change to a mechanism.
void add_file_numbers(const DeviceParameters& device, std::vector<DesignParameter>& parameters) {
  for (const auto& [number, of_file] : device.mechanism->mechanism.file_numbers) {
    const std::string key = fmt::format("{}.{}", path_of(DeviceTable::mechanism), number);
    const double value = parameter(device, key).value();
    const bool is_of_tendon = number.starts_with("tendon.");
    const Kind kind = number.ends_with(".damping")     ? Kind::mechanism_damping
                      : number.ends_with(".stiffness") ? Kind::mechanism_stiffness
                                                       : Kind::mechanism_inertia;
    if (value > 0.0 || (!is_of_tendon && kind != Kind::mechanism_stiffness))
      parameters.push_back({kind, 0, key, value});
  }
}

// A cable of no stiffness is none: no number that could grow.
void add_mechanism(const DeviceParameters& device, std::vector<DesignParameter>& parameters) {
  const MechanismFile& mechanism = device.mechanism->mechanism;
  for (const auto& [joint, position] : mechanism.pose) {
    parameters.push_back({Kind::joint_position, 0, "mechanism.pose." + joint, position});
  }
  add_file_numbers(device, parameters);
  for (std::size_t i = 0; i < mechanism.transmissions.size(); ++i) {
    const Transmission& motor = mechanism.transmissions[i];
    const auto add = [&](const char* name, double value) {
      parameters.push_back({Kind::transmission, i, fmt::format("transmission.{}.{}", i, name), value});
    };
    add("ratio", motor.ratio);
    add("inertia", motor.inertia);
    add("motor_damping", motor.motor_damping);
    if (!(motor.stiffness > 0.0)) continue;
    add("stiffness", motor.stiffness);
    add("damping", motor.damping);
  }
}

}  // namespace

std::vector<DesignParameter> design_parameters(const Device& device) {
  const DeviceParameters& d = device.parameters();
  std::vector<DesignParameter> parameters;
  parameters.reserve(3 * d.bodies.size() + 2 * d.links.size() + 8 + 3 * d.wall.filters.size());
  for (std::size_t i = 0; i < d.bodies.size(); ++i) {
    const std::string key = "body." + d.bodies[i].name;
    parameters.push_back({Kind::body_mass, i, key + ".mass", d.bodies[i].mass});
    parameters.push_back({Kind::body_damping, i, key + ".damping", d.bodies[i].damping});
    parameters.push_back({Kind::body_stiffness, i, key + ".stiffness", d.bodies[i].stiffness});
  }
  for (std::size_t i = 0; i < d.links.size(); ++i) {
    const std::string key = "link." + std::to_string(i);
    parameters.push_back({Kind::link_stiffness, i, key + ".stiffness", d.links[i].stiffness});
    parameters.push_back({Kind::link_damping, i, key + ".damping", d.links[i].damping});
  }
  if (d.mechanism) add_mechanism(d, parameters);
  parameters.push_back({Kind::sampling_period, 0, "loop.sampling_period", d.loop.sampling_period});
  parameters.push_back({Kind::delay, 0, "loop.delay", d.loop.delay});
  parameters.push_back({Kind::time_constant, 0, "actuator.time_constant", d.actuator.time_constant});
  if (d.sensor.tracking_bandwidth > 0.0) {
    parameters.push_back({Kind::tracking_bandwidth, 0, "sensor.tracking_bandwidth", d.sensor.tracking_bandwidth});
  }
  parameters.push_back({Kind::wall_damping, 0, "wall.damping", d.wall.damping});
  if (d.wall.velocity_filter_hz > 0.0) {
    parameters.push_back({Kind::velocity_filter_hz, 0, "wall.velocity_filter_hz", d.wall.velocity_filter_hz});
  }
  for (std::size_t i = 0; i < d.wall.filters.size(); ++i) add_filter(d.wall.filters[i], i, parameters);
  if (!device.is_mechanical()) return parameters;
  parameters.push_back({Kind::user_mass, 0, "operator.mass", d.user.mass});
  parameters.push_back({Kind::user_damping, 0, "operator.damping", d.user.damping});
  parameters.push_back({Kind::user_stiffness, 0, "operator.stiffness", d.user.stiffness});
  return parameters;
}

}  // namespace zwidth::internal
