#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace zwidth {

/// What a formula for rigid devices leaves out, and a device has.
enum class UnmetAssumption {
  flexible_links,     ///< between its bodies
  springs_to_ground,  ///< at a body
  delay,              ///< of the force
  actuator_lag,       ///< of the force
  tracking,           ///< of the position, by the drive
  velocity_filter,    ///< of the virtual damper
  virtual_damper,     ///< beside the wall's spring
  wall_filters,       ///< on the wall's force
  user_stiffness,     ///< of the user who holds
};

/// "flexible links", "a delay".
[[nodiscard]] std::string_view words_of(UnmetAssumption assumption);
/// Those of each.
[[nodiscard]] std::vector<std::string> words_of(std::span<const UnmetAssumption> assumptions);

}  // namespace zwidth
