#pragma once

#include <string>
#include <string_view>

#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/design/wall_to_run.hpp"

namespace zwidth::report {

/// A wall to write as code.
struct CodedWall {
  WallToRun wall;
  ControllerOptions::Contact contact = ControllerOptions::Contact::bilateral;
  std::string stiffness_source;  ///< "wall.stiffness of the device file": where K comes from
};

/// A self-contained C99 file: the state of the wall, `<name>_wall_reset()` and `<name>_wall_force()`, the same
/// arithmetic in the same order as SampledController, and the actuator's force limit behind it. Where loop.damper runs the
/// damper apart: the damper's state and `<name>_damper_reset()`, `<name>_damper_step()` as SampledDamper,
/// `<name>_spring_step()`, and `<name>_wall_sum()` as sum_of_paths() with the limit behind it. Requires
/// wall.stiffness; throws Error (invalid_argument) without.
[[nodiscard]] std::string export_c(const CodedWall& wall);

/// The device's name as the beginning of C identifiers: lower-case letters, digits and _, a letter first, at most 20
/// characters, so that C99's 31 significant ones tell `<name>_wall_force` from `<name>_wall_reset`, and `<name>_spring_step` from `<name>_damper_step`. "device" for a name
/// without any letter or digit.
[[nodiscard]] std::string c_identifier(std::string_view name);

}  // namespace zwidth::report
