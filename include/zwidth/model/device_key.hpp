#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace zwidth {

/// The tables of a device file, in its order.
enum class DeviceTable {
  root,               ///< the top level
  body,               ///< [[body]]
  link,               ///< [[link]]
  mechanism,          ///< [mechanism]
  mechanism_pose,     ///< [mechanism.pose], whose keys are joints
  mechanism_joint,    ///< [mechanism.joint.NAME]
  mechanism_tendon,   ///< [mechanism.tendon.NAME]
  transmission,       ///< [[transmission]]
  loop,               ///< [loop]
  loop_damper,        ///< [loop.damper]
  actuator,           ///< [actuator]
  sensor,             ///< [sensor]
  wall,               ///< [wall]
  filter,             ///< [[wall.filter]]
  user,               ///< [operator]
  transfer_function,  ///< [transfer_function]
  uncertainty,        ///< [uncertainty]
  driver              ///< [driver]
};

/// What a number measures: which units it may have.
enum class Measure {
  ratio,
  time,
  frequency_hz,
  angular_frequency,
  position,
  force,
  mass,
  damping,
  stiffness,
  velocity,
  torque_per_current,
  torque_per_voltage
};

/// What stands behind a key.
enum class KeyType { number, whole_number, sign, text, numbers, texts, matrix };

/// The numbers that a key takes: from `least` to `greatest`, and 0 where it takes that.
struct NumberRange {
  double least = 0.0;       ///< in SI units
  double greatest = 0.0;    ///< in SI units
  bool takes_zero = false;  ///< beside them

  /// Whether it takes the number; never a NaN.
  [[nodiscard]] bool contains(double value) const {
    return (takes_zero && value == 0.0) || (value >= least && value <= greatest);
  }
  /// Member by member.
  bool operator==(const NumberRange&) const = default;
};

// Squares, and products and quotients of three such values, stay finite and normal in double precision.
inline constexpr NumberRange positive_numbers{1e-30, 1e30, false};     ///< of any quantity
inline constexpr NumberRange not_negative_numbers{1e-30, 1e30, true};  ///< of any quantity

inline constexpr std::string_view needed_key = "needed";  ///< DeviceKey::otherwise of what must be given

/// A key of the device file: what its reader, writer, `parameter()`, documents and fronts know of it.
struct DeviceKey {
  DeviceTable table = DeviceTable::root;  ///< in which it stands
  std::string_view name;                  ///< "sampling_period"
  KeyType type = KeyType::number;         ///< of its value
  std::optional<Measure> measure = {};    ///< of a number; none: it takes no unit
  std::optional<NumberRange> range = {};  ///< of a number; none: as `allowed` says
  std::string_view otherwise = {};        ///< what holds where it is left out: "0", "none", needed_key
  std::string_view allowed = {};          ///< beside the range
  std::string_view help = {};             ///< a sentence
  std::string_view same_as = {};          ///< the key beside it that it stands for: "mass" of "inertia"
  std::string_view since = "1.0";         ///< version of zwidth
};

/// A table of the device file as a key of the one that holds it.
struct DeviceTableKey {
  DeviceTable table = DeviceTable::root;   ///< itself
  DeviceTable parent = DeviceTable::root;  ///< the one that holds it
  std::string_view name;                   ///< its key there: "body", "operator", "filter"; empty for the root
  bool is_many = false;                    ///< [[name]] instead of [name]
  std::string_view otherwise = {};         ///< what holds where it is left out
  std::string_view allowed = {};           ///< how often, and beside what
  std::string_view since = "1.0";          ///< version of zwidth
  bool is_by_name = false;                 ///< [name.NAME], a table for each name, instead of [name]
};

/// Every key, in the order in which a file is written.
[[nodiscard]] std::span<const DeviceKey> device_keys();

/// Every table, in the order of DeviceTable.
[[nodiscard]] std::span<const DeviceTableKey> device_tables();

/// The table's key from the root: "body", "wall.filter"; empty for the root.
[[nodiscard]] std::string path_of(DeviceTable table);

/// How the table is written in a file: "[[body]]", "[loop]", "[mechanism.joint.NAME]", "the top level".
[[nodiscard]] std::string header_of(DeviceTable table);

/// What the number of a device's key measures: "loop.delay" a time, and so does "delay"; none of what is no key, or no number.
[[nodiscard]] std::optional<Measure> measure_of(std::string_view key);

}  // namespace zwidth
