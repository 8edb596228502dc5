#pragma once

#include <string>

#include "zwidth/rig/results.hpp"

namespace zwidth::report {

// What an action on a rig found, for a reader; then the session: how the loop ran, and how it ended.
[[nodiscard]] std::string rig_text(const Device& device, const RigCheck& check);
[[nodiscard]] std::string rig_text(const Device& device, const RigMeasurement& measurement);
[[nodiscard]] std::string rig_text(const Device& device, const RigIdentification& identification);
[[nodiscard]] std::string rig_text(const Device& device, const RigRelay& relay);
[[nodiscard]] std::string rig_text(const Device& device, const RigWall& wall);
[[nodiscard]] std::string rig_text(const Device& device, const RigLimit& limit);

}  // namespace zwidth::report
