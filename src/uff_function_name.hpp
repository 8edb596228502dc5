#pragma once

#include <string>

namespace zwidth::internal {

/// What a record of a universal file is, by its function type: "time response", "frequency response".
[[nodiscard]] std::string uff_function_name(int function_type);

}  // namespace zwidth::internal
