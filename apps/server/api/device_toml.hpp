#pragma once

#include <string>
#include <tl/expected.hpp>

#include "results/json.hpp"
#include "server/api/command_request.hpp"

namespace zwidth::server {

/// The text of a device file (a study file, as `name` says) with the keys of this JSON object, one of them a line, so that
/// an error's line is of that key. Refused: what is no object, and null.
[[nodiscard]] tl::expected<std::string, Problem> device_toml(const results::Json& device,
                                                             const std::string& name = "device");

}  // namespace zwidth::server
