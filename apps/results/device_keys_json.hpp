#pragma once

#include "results/json.hpp"

namespace zwidth::results {

/// The keys of the device file: {"tables": [{"path": "loop", "header": "[loop]", "keys": [{"key": "delay", "unit": ...}]}]}.
[[nodiscard]] Json device_keys_json();

}  // namespace zwidth::results
