#pragma once

#include <span>
#include <string>
#include <string_view>

#include "zwidth/model/device_key.hpp"

namespace zwidth::internal {

/// Every key that may stand in the table, those of tables below it last.
[[nodiscard]] std::span<const std::string> keys_of(DeviceTable table);

/// The table's row of device_tables().
[[nodiscard]] const DeviceTableKey& entry_of(DeviceTable table);

[[nodiscard]] bool is_key_of(DeviceTable table, std::string_view key);

/// What to do about a key that does not stand in the table: the key that was meant, the table where it belongs, or the
/// list of keys.
[[nodiscard]] std::string remedy_for_unknown_key(DeviceTable table, std::string_view key);

}  // namespace zwidth::internal
