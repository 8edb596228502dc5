#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zwidth::internal {

/// The tables of a device file.
enum class DeviceTable {
  root,
  body,
  link,
  loop,
  actuator,
  sensor,
  wall,
  filter,
  user,
  transfer_function,
  uncertainty,
  driver
};

/// Every key that may stand in the table.
[[nodiscard]] std::span<const std::string> keys_of(DeviceTable table);

/// Name of the table's key in the table that holds it, the root but for filters: "body", "operator", "filter"; empty
/// for the root.
[[nodiscard]] std::string_view name_of(DeviceTable table);

/// Its key from the root: "body", "wall.filter".
[[nodiscard]] std::string path_of(DeviceTable table);

/// How the table is written in a file: "[[body]]", "[loop]", "[[wall.filter]]".
[[nodiscard]] std::string header_of(DeviceTable table);

[[nodiscard]] bool is_key_of(DeviceTable table, std::string_view key);

/// What to do about a key that does not stand in the table: the key that was meant, the table where it belongs, or the
/// list of keys.
[[nodiscard]] std::string remedy_for_unknown_key(DeviceTable table, std::string_view key);

}  // namespace zwidth::internal
