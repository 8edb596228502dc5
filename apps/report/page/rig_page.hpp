#pragma once

#include <string>

#include "zwidth/rig/results.hpp"

namespace zwidth::report {

// One self-contained page of what an action on a rig found, with its figures, when and within which limits it ran, and the
// device. Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string rig_page(const Device& device, const RigCheck& check);
[[nodiscard]] std::string rig_page(const Device& device, const RigMeasurement& measurement);
[[nodiscard]] std::string rig_page(const Device& device, const RigIdentification& identification);
[[nodiscard]] std::string rig_page(const Device& device, const RigRelay& relay);
[[nodiscard]] std::string rig_page(const Device& device, const RigWall& wall);
[[nodiscard]] std::string rig_page(const Device& device, const RigLimit& limit);

}  // namespace zwidth::report
