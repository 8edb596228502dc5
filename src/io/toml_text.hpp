#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "io/toml.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {

/// Parses TOML text; an error carries the place in `source`. Never throws, never exhausts the stack.
[[nodiscard]] tl::expected<toml::table, InputError> parse_toml(std::string_view text, std::string_view source);

/// The place of keys that an override adds.
[[nodiscard]] toml::source_region override_region();

}  // namespace zwidth
