#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "server/api/command_request.hpp"
#include "server/api/recording_store.hpp"

namespace zwidth::server {

/// The request that a document makes: {"device": {...} | "device_toml": "...", "recording": ID | {"id", "name"},
/// "recordings": [...], "study": {...} | "study_toml": "...", "options": {...}}, every key optional. `recordings` finds the ids.
[[nodiscard]] tl::expected<CommandRequest, Problem> read_request(std::string_view command, std::string_view document,
                                                                 RecordingStore& recordings);

}  // namespace zwidth::server
