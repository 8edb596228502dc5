#pragma once

#include <optional>
#include <string>

#include "io/toml.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::internal {

/// Puts one "KEY=VALUE" into the document, or says why not. Where the document itself is malformed on the way to the
/// key it is left alone: reading it reports that.
[[nodiscard]] std::optional<InputError> apply_override(toml::table& document, const std::string& assignment);

}  // namespace zwidth::internal
