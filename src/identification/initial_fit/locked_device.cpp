#include <algorithm>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth {
namespace {

/// Marks every body that moves with the actuator: those that free links connect to it.
std::vector<bool> moving_bodies(const Device& device, const std::vector<bool>& is_locked) {
  std::vector<bool> moves(device.bodies().size(), false);
  moves[device.loop().actuated] = true;
  for (bool spreading = true; spreading;) {  // each pass reaches a further body or is the last
    spreading = false;
    for (const Link& link : device.links()) {
      if (is_locked[link.first] || is_locked[link.second] || moves[link.first] == moves[link.second]) continue;
      moves[link.first] = moves[link.second] = true;
      spreading = true;
    }
  }
  return moves;
}

void check_locked(const Device& device, const std::vector<std::size_t>& locked) {
  if (!device.has_bodies()) {
    throw Error(ErrorCode::invalid_argument, Problem{.code = ProblemCode::locking_transfer_function});
  }
  for (const std::size_t body : locked) {
    if (body >= device.bodies().size()) {
      throw Error(ErrorCode::invalid_argument,
                  Problem{.code = ProblemCode::no_body_to_lock, .evidence = {internal::counted("body", body)}});
    }
    for (const auto& [role, index] :
         {std::pair{"actuated", device.loop().actuated}, {"sensed", device.loop().sensed}}) {
      if (body != index) continue;
      throw Error(ErrorCode::invalid_argument,
                  Problem{.code = ProblemCode::locked_body_needed,
                          .subjects = {{"role", role}, {"name", device.bodies()[body].name}}});
    }
  }
}

}  // namespace

Device locked_device(const Device& device, const std::vector<std::size_t>& locked) {
  check_locked(device, locked);
  if (locked.empty()) return device;
  std::vector<bool> is_locked(device.bodies().size(), false);
  for (const std::size_t body : locked) is_locked[body] = true;
  const std::vector<bool> moves = moving_bodies(device, is_locked);
  if (!moves[device.loop().sensed]) {
    throw Error(ErrorCode::invalid_argument, Problem{.code = ProblemCode::locked_bodies_part_device});
  }

  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();  // its keys may name what is gone
  parameters.bodies.clear();
  parameters.links.clear();
  std::vector<std::size_t> index(device.bodies().size(), 0);
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    if (!moves[i]) continue;
    index[i] = parameters.bodies.size();
    parameters.bodies.push_back(device.bodies()[i]);
  }
  for (const Link& link : device.links()) {
    if (moves[link.first] && moves[link.second]) {
      parameters.links.push_back({index[link.first], index[link.second], link.stiffness, link.damping});
    } else if (moves[link.first] || moves[link.second]) {  // the other end is held still
      Body& body = parameters.bodies[index[moves[link.first] ? link.first : link.second]];
      body.stiffness += link.stiffness;
      body.damping += link.damping;
    }
  }
  const std::size_t held = device.loop().held;
  if (!moves[held]) parameters.user = {};  // an operator at a body that stands still does nothing
  parameters.loop.actuated = index[device.loop().actuated];
  parameters.loop.sensed = index[device.loop().sensed];
  parameters.loop.held = moves[held] ? index[held] : parameters.loop.actuated;
  return Device(std::move(parameters));
}

}  // namespace zwidth
