#pragma once

#include <string>
#include <string_view>

namespace zwidth::server {

/// SHA-256 in hexadecimal.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Compared in a time that does not tell how much is equal, only whether the lengths are.
[[nodiscard]] bool equal_in_constant_time(std::string_view one, std::string_view other);

}  // namespace zwidth::server
