#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "io/toml.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::internal {

/// What is wrong where a number does not fit its type, and what fits everywhere in a device file.
inline constexpr std::string_view number_out_of_range = "the number is out of range";
inline constexpr std::string_view number_range =
    "must be 0 or from 1e-30 to 1e30 in magnitude (coefficients: 1e-100 to 1e100)";

/// Parses TOML text; an error carries the place in `source`, and says what the text is to be `of`. Never throws, never
/// exhausts the stack.
[[nodiscard]] tl::expected<toml::table, InputError> parse_toml(std::string_view text, std::string_view source,
                                                               std::string_view of = "a device");

/// A word, or a number and something of a unit: text that lacks its quotes.
[[nodiscard]] bool is_bare_text(std::string_view text);

/// The place of keys that an override adds.
[[nodiscard]] toml::source_region override_region();

}  // namespace zwidth::internal
