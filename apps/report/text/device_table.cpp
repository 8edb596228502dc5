#include "report/text/device_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <string_view>
#include <utility>

#include "report/text/quantity.hpp"
#include "report/text/wall_filter_text.hpp"

namespace zwidth::report {

TextTable device_table(const Device& of) {
  const DeviceParameters& device = of.parameters();
  const Units units = units_of(device.motion);
  TextTable table{{Align::left, Align::right}, {{"parameter", "value"}}};
  const auto add = [&](std::string name, double value, std::string_view unit) {
    table.rows.push_back({std::move(name), fmt::format("{:.9g} {}", value, unit)});
  };
  const auto add_if = [&](std::string name, double value, std::string_view unit) {
    if (value != 0.0) add(std::move(name), value, unit);
  };
  for (const Body& body : device.bodies) {
    add(body.name + ": mass", body.mass, units.mass);
    add(body.name + ": damping to ground", body.damping, units.damping);
    add_if(body.name + ": stiffness to ground", body.stiffness, units.stiffness);
    add_if(body.name + ": Coulomb friction (not in the analysis)", body.coulomb, units.force);
  }
  for (const Link& link : device.links) {
    const std::string name = fmt::format("{} to {}", device.bodies[link.first].name, device.bodies[link.second].name);
    add(name + ": stiffness", link.stiffness, units.stiffness);
    add(name + ": damping", link.damping, units.damping);
  }
  if (device.transfer_function) {
    table.rows.push_back({"numerator, descending powers of s",
                          fmt::format("{:.9g}", fmt::join(device.transfer_function->numerator, ", "))});
    table.rows.push_back(
        {"denominator", fmt::format("{:.9g}", fmt::join(device.transfer_function->denominator, ", "))});
  } else if (device.mechanism) {
    const auto& [mechanism, normal, is_point] = *device.mechanism;
    table.rows.push_back({"tip of the mechanism", mechanism.tip});
    for (const auto& [joint, position] : mechanism.pose) {
      table.rows.push_back({joint + ": position", fmt::format("{:.9g}", position)});
    }
    table.rows.push_back({"normal of the wall", is_point ? "all" : fmt::format("{:.9g}", fmt::join(normal, ", "))});
  } else if (!device.bodies.empty()) {
    table.rows.push_back({"actuated, sensed, held",
                          fmt::format("{}, {}, {}", device.bodies[device.loop.actuated].name,
                                      device.bodies[device.loop.sensed].name, device.bodies[device.loop.held].name)});
  }
  add("sampling period", device.loop.sampling_period, "s");
  add("delay besides the hold", device.loop.delay, "s");
  add_if("actuator time constant", device.actuator.time_constant, "s");
  if (device.actuator.force_limit) add("actuator force limit", *device.actuator.force_limit, units.force);
  add_if("encoder step", device.sensor.resolution, units.length);
  add_if("tracking of the position by the drive", device.sensor.tracking_bandwidth, "rad/s");
  add_if("operator: mass", device.user.mass, units.mass);
  add_if("operator: damping", device.user.damping, units.damping);
  add_if("operator: stiffness", device.user.stiffness, units.stiffness);
  if (device.wall.stiffness) add("wall: stiffness", *device.wall.stiffness, units.stiffness);
  add_if("wall: damping", device.wall.damping, units.damping);
  add_if("wall: velocity filter", device.wall.velocity_filter_hz, "Hz");
  for (const WallFilter& filter : device.wall.filters) table.rows.push_back({"wall: filter", filter_text(filter)});
  return table;
}

}  // namespace zwidth::report
