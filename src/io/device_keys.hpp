#pragma once

#include <span>
#include <string>
#include <string_view>

#include "zwidth/model/device_key.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// Every key that may stand in the table, those of tables below it last.
[[nodiscard]] std::span<const std::string> keys_of(DeviceTable table);

/// The table's row of device_tables().
[[nodiscard]] const DeviceTableKey& entry_of(DeviceTable table);

[[nodiscard]] bool is_key_of(DeviceTable table, std::string_view key);

/// A key that does not stand in the table, with the key that was meant, the table where it belongs, or the list of keys.
[[nodiscard]] Problem unknown_key_of(DeviceTable table, std::string_view key);
/// The same of a table that has these keys.
[[nodiscard]] Problem unknown_key_beside(std::span<const std::string> keys, std::string_view key);

}  // namespace zwidth::internal
