#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "io/toml.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::internal {

/// Parses TOML text; an error carries the place in `source`, and says what the text is to be `of`. Never throws, never
/// exhausts the stack.
[[nodiscard]] tl::expected<toml::table, InputError> parse_toml(std::string_view text, std::string_view source,
                                                               std::string_view of = "a device");

/// A word, or a number and something of a unit: text that lacks its quotes.
[[nodiscard]] bool is_bare_text(std::string_view text);

/// The place of keys that an override adds.
[[nodiscard]] toml::source_region override_region();

}  // namespace zwidth::internal
