#include "cli/place_of_damper.hpp"

#include <string_view>
#include <utility>

#include "cli/option_refusal.hpp"
#include "rig/rig_actions.hpp"

namespace zwidth::cli {
namespace {

constexpr std::pair<std::string_view, std::string_view> options_of_damper[] = {{"damper_on_drive", "--damper-on-drive"},
                                                                               {"controller.contact", "--contact"}};

}  // namespace

void check_place_of_damper(const RigArguments& arguments, const Device& device) {
  if (arguments.action != "wall" && arguments.action != "limit" && arguments.action != "relay") return;
  rig::WallOptions wall;
  wall.controller = wall_controller(device.parameters().wall);
  if (arguments.contact == "unilateral") wall.controller.contact = ControllerOptions::Contact::unilateral;
  wall.damper_on_drive = arguments.damper_on_drive;
  if (const auto problem = find_problem(wall, device)) {
    refuse(*problem, options_of_damper, arguments.devices.files.front());
  }
}

}  // namespace zwidth::cli
