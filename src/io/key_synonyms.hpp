#pragma once

#include <string_view>
#include <vector>

#include "io/device_keys.hpp"
#include "zwidth/finding.hpp"

namespace zwidth::internal {

/// What to write instead of a name that other programs, books and datasheets give to a number of a device file:
/// "sampling_frequency", "cpr", "J"; as the phrase of an
/// unknown key names it. Empty where the name is none of them.
[[nodiscard]] std::vector<Subject> remedy_for_synonym(DeviceTable table, std::string_view key);

}  // namespace zwidth::internal
