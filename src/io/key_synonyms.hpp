#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/device_keys.hpp"

namespace zwidth::internal {

/// What to write instead of a name that other programs, books and datasheets give to a number of a device file:
/// "sampling_frequency", "cpr", "J". None where the name is none of them.
[[nodiscard]] std::optional<std::string> remedy_for_synonym(DeviceTable table, std::string_view key);

}  // namespace zwidth::internal
