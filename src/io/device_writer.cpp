#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/key_members.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/wall_filter_type.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// A TOML basic string on one line.
std::string text_value(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\u{:04x}", byte);
      continue;
    }
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// A text of several lines as it is, where TOML can hold it so.
std::string lines_value(const std::string& text) {
  const auto is_control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
  };
  if (text.find("'''") != std::string::npos || text.ends_with('\'') || std::ranges::any_of(text, is_control)) {
    return text_value(text);
  }
  return fmt::format("'''\n{}'''", text);
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

std::string plain_value(double value) { return number_value(value); }
std::string plain_value(int value) { return fmt::format("{}", value); }
std::string plain_value(const std::string& value) { return text_value(value); }

class Writer {
 public:
  explicit Writer(Motion motion) : motion_(motion) {}
  void header(DeviceTable kind) { text_ += fmt::format("\n{}\n", header_of(kind)); }
  void value(std::string_view key, std::string_view toml) { text_ += fmt::format("{} = {}\n", key, toml); }
  /// As they stand in the file.
  void whole_table(std::string_view header, std::string_view values) { text_ += fmt::format("{}{}", header, values); }
  /// Every key that has a member in the table's struct, and a value in it.
  template <typename Table>
  void members(DeviceTable kind, const Table& table) {
    visit_members(kind, table, [&](const DeviceKey& key, const auto& member) {
      if constexpr (std::is_same_v<Table, WallFilter>) {
        if (!is_number_of(table, key.name)) return;
      }
      const bool is_inertia = key.measure == Measure::mass && motion_ == Motion::rotary;
      if constexpr (requires { member.value(); }) {
        if (member) value(key.name, plain_value(*member));
      } else {
        value(is_inertia ? "inertia" : key.name, plain_value(member));
      }
    });
  }
  template <typename Table>
  void table(DeviceTable kind, const Table& table) {
    header(kind);
    members(kind, table);
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  Motion motion_;
  std::string text_;
};

void write_bodies(const DeviceParameters& device, Writer& out) {
  for (const Body& body : device.bodies) {
    out.header(DeviceTable::body);
    out.value("name", text_value(body.name));
    out.members(DeviceTable::body, body);
  }
  for (const Link& link : device.links) {
    out.header(DeviceTable::link);
    out.value("between", fmt::format("[{}, {}]", text_value(device.bodies[link.first].name),
                                     text_value(device.bodies[link.second].name)));
    out.members(DeviceTable::link, link);
  }
}

void write_mechanism(const DeviceParameters& device, Writer& out) {
  if (!device.mechanism) return;
  const auto& [mechanism, normal, is_point] = *device.mechanism;
  out.header(DeviceTable::mechanism);
  if (mechanism.path.empty()) {
    out.value("text", lines_value(mechanism.text));
  } else {
    out.value("file", text_value(mechanism.path));
  }
  out.value("tip", text_value(mechanism.tip));
  if (!mechanism.encoders.empty()) out.value("encoders", text_array_value(mechanism.encoders));
  out.value("normal", is_point ? text_value("all") : array_value({normal.begin(), normal.end()}));
  if (!mechanism.pose.empty()) out.header(DeviceTable::mechanism_pose);
  for (const auto& [joint, position] : mechanism.pose) out.value(text_value(joint), number_value(position));
  std::map<std::string, std::string> tables;  // of joints and tendons
  for (const auto& [key, number] : mechanism.numbers) {
    const MechanismNumberName of(key);
    const std::string header = fmt::format("\n[mechanism.{}.{}]\n", of.kind, text_value(std::string(of.part)));
    tables[header] += fmt::format("{} = {}\n", of.attribute, number_value(number));
  }
  for (const auto& [header, values] : tables) out.whole_table(header, values);
  for (const Transmission& each : mechanism.transmissions) {
    out.header(DeviceTable::transmission);
    out.value("joint", text_value(each.joint));
    out.members(DeviceTable::transmission, each);
  }
}

void write_filters(const DeviceParameters& device, Writer& out) {
  using enum WallFilter::Kind;
  for (const WallFilter& filter : device.wall.filters) {
    out.header(DeviceTable::filter);
    out.value("type", text_value(wall_filter_type(filter.kind)));
    out.members(DeviceTable::filter, filter);
    if (filter.kind == biquad || filter.kind == digital) {
      out.value("numerator", array_value(filter.numerator));
      out.value("denominator", array_value(filter.denominator));
    }
  }
}

}  // namespace

std::string write_device(const DeviceParameters& parameters) {
  const Device checked(parameters);
  const DeviceParameters& device = checked.parameters();
  if (!device.mechanism) require_no_coordinates(checked);
  Writer out(device.motion);
  out.value("name", text_value(device.name));
  out.value("motion", device.motion == Motion::rotary ? "\"rotary\"" : "\"linear\"");
  write_bodies(device, out);
  write_mechanism(device, out);
  if (device.transfer_function) {
    out.header(DeviceTable::transfer_function);
    out.value("numerator", array_value(device.transfer_function->numerator));
    out.value("denominator", array_value(device.transfer_function->denominator));
  }
  out.header(DeviceTable::loop);
  if (checked.has_bodies()) {
    out.value("actuated", text_value(device.bodies[device.loop.actuated].name));
    out.value("sensed", text_value(device.bodies[device.loop.sensed].name));
    out.value("held", text_value(device.bodies[device.loop.held].name));
  }
  out.members(DeviceTable::loop, device.loop);
  if (device.loop.damper) out.table(DeviceTable::loop_damper, *device.loop.damper);
  out.table(DeviceTable::actuator, device.actuator);
  out.table(DeviceTable::sensor, device.sensor);
  out.table(DeviceTable::wall, device.wall);
  write_filters(device, out);
  if (checked.is_mechanical()) out.table(DeviceTable::user, device.user);
  if (device.driver) out.table(DeviceTable::driver, *device.driver);
  if (device.uncertainty) {
    out.header(DeviceTable::uncertainty);
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
