#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

/// A TOML basic string; find_problem() has ruled out control characters.
std::string text_value(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// The shortest digits that read back to the same double, at most 17.
std::string number_value(double value) {
  const std::string digits = fmt::format("{}", value);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

std::string array_value(const std::vector<double>& values) {
  // One value a line: the reader takes any number of coefficients so, and long rows are hard to compare.
  std::string result = "[\n";
  for (const double value : values) result += fmt::format("  {},\n", number_value(value));
  return result + "]";
}

class Writer {
 public:
  void header(std::string_view text) { text_ += fmt::format("\n{}\n", text); }
  void value(std::string_view key, std::string_view toml) { text_ += fmt::format("{} = {}\n", key, toml); }
  void number(std::string_view key, double value_of_key) { value(key, number_value(value_of_key)); }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

void write_bodies(const DeviceParameters& device, std::string_view mass, Writer& out) {
  for (const Body& body : device.bodies) {
    out.header("[[body]]");
    out.value("name", text_value(body.name));
    out.number(mass, body.mass);
    out.number("damping", body.damping);
    out.number("stiffness", body.stiffness);
    out.number("coulomb", body.coulomb);
  }
  for (const Link& link : device.links) {
    out.header("[[link]]");
    out.value("between", fmt::format("[{}, {}]", text_value(device.bodies[link.first].name),
                                     text_value(device.bodies[link.second].name)));
    out.number("stiffness", link.stiffness);
    out.number("damping", link.damping);
  }
}

}  // namespace

std::string write_device(const DeviceParameters& parameters) {
  const Device checked(parameters);
  const DeviceParameters& device = checked.parameters();
  const std::string_view mass = device.motion == Motion::rotary ? "inertia" : "mass";
  Writer out;
  out.value("name", text_value(device.name));
  out.value("motion", device.motion == Motion::rotary ? "\"rotary\"" : "\"linear\"");
  write_bodies(device, mass, out);
  if (device.transfer_function) {
    out.header("[transfer_function]");
    out.value("numerator", array_value(device.transfer_function->numerator));
    out.value("denominator", array_value(device.transfer_function->denominator));
  }
  out.header("[loop]");
  if (checked.has_bodies()) {
    out.value("actuated", text_value(device.bodies[device.loop.actuated].name));
    out.value("sensed", text_value(device.bodies[device.loop.sensed].name));
    out.value("held", text_value(device.bodies[device.loop.held].name));
  }
  out.number("sampling_period", device.loop.sampling_period);
  out.number("delay", device.loop.delay);
  out.header("[actuator]");
  out.number("time_constant", device.actuator.time_constant);
  if (device.actuator.force_limit) out.number("force_limit", *device.actuator.force_limit);
  out.header("[sensor]");
  out.number("resolution", device.sensor.resolution);
  out.header("[wall]");
  if (device.wall.stiffness) out.number("stiffness", *device.wall.stiffness);
  out.number("damping", device.wall.damping);
  out.number("velocity_filter_hz", device.wall.velocity_filter_hz);
  if (checked.has_bodies()) {
    out.header("[operator]");
    out.number(mass, device.user.mass);
    out.number("damping", device.user.damping);
    out.number("stiffness", device.user.stiffness);
  }
  return std::move(out).text();
}

}  // namespace zwidth
