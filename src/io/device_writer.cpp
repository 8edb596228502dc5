#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zwidth/io/device_file.hpp"
#include "zwidth/io/wall_filter_type.hpp"

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

std::string text_array_value(const std::vector<std::string>& texts) {
  std::string result = "[\n";
  for (const std::string& text : texts) result += fmt::format("  {},\n", text_value(text));
  return result + "]";
}

std::string rows_value(const std::vector<std::vector<double>>& rows) {
  std::string result = "[\n";
  for (const std::vector<double>& row : rows) {
    result += "  [";
    for (std::size_t i = 0; i < row.size(); ++i) result += (i == 0 ? "" : ", ") + number_value(row[i]);
    result += "],\n";
  }
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

void write_filters(const DeviceParameters& device, Writer& out) {
  using enum WallFilter::Kind;
  for (const WallFilter& filter : device.wall.filters) {
    out.header("[[wall.filter]]");
    out.value("type", text_value(wall_filter_type(filter.kind)));
    if (filter.frequency_hz > 0.0) out.number("frequency_hz", filter.frequency_hz);
    if (filter.kind == low_pass) out.value("order", fmt::format("{}", filter.order));
    if (filter.kind == notch || (filter.kind == low_pass && filter.order == 2)) {
      out.number("damping_ratio", filter.damping_ratio);
    }
    if (filter.kind == notch) out.number("depth", filter.depth);
    if (filter.kind == lead_lag) out.number("ratio", filter.ratio);
    if (filter.kind == biquad || filter.kind == digital) {
      out.value("numerator", array_value(filter.numerator));
      out.value("denominator", array_value(filter.denominator));
    }
  }
}

void write_driver(const MotorDrive& drive, Writer& out) {
  out.header("[driver]");
  if (drive.travel) out.number("travel", *drive.travel);
  out.number("gear", drive.gear);
  out.number("sign", drive.sign);
  if (drive.torque_constant) out.number("torque_constant", *drive.torque_constant);
  if (drive.torque_per_volt) out.number("torque_per_volt", *drive.torque_per_volt);
  if (drive.id) out.value("id", fmt::format("{}", *drive.id));
  out.value("command", text_value(drive.command));
  if (drive.baud) out.value("baud", fmt::format("{}", *drive.baud));
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
  write_filters(device, out);
  if (checked.has_bodies()) {
    out.header("[operator]");
    out.number(mass, device.user.mass);
    out.number("damping", device.user.damping);
    out.number("stiffness", device.user.stiffness);
  }
  if (device.driver) write_driver(*device.driver, out);
  if (device.uncertainty) {
    out.header("[uncertainty]");
    const Uncertainty& uncertainty = *device.uncertainty;
    if (!uncertainty.parameters.empty()) {
      out.value("parameters", text_array_value(uncertainty.parameters));
      out.value("covariance", rows_value(uncertainty.covariance));
    }
    if (uncertainty.verdict != Trust::Verdict::sound) {
      out.value("verdict", uncertainty.verdict == Trust::Verdict::refused ? "\"refused\"" : "\"doubtful\"");
    }
    if (!uncertainty.warning.empty()) out.value("warning", text_value(uncertainty.warning));
    if (!uncertainty.reasons.empty()) out.value("reasons", text_array_value(uncertainty.reasons));
    if (!uncertainty.assumed.empty()) out.value("assumed", text_array_value(uncertainty.assumed));
  }
  return std::move(out).text();
}

std::string write_device(const DeviceParameters& parameters, std::span<const Remark> remarks) {
  std::string text;
  for (const Remark& remark : remarks) {
    std::string line = (remark.severity == Remark::Severity::warning ? "WARNING: " : "note: ") + remark_line(remark);
    std::ranges::replace_if(
        line, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    text += "# " + line + "\n";
  }
  return text + write_device(parameters);
}

}  // namespace zwidth
