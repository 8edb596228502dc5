#include <algorithm>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

constexpr double spring_deviation = 1.0;

/// -k x on the held body: a hand that rests, a cable, a spring that the structure lacks. It is believed to be as stiff as the
/// force over the position allows (theory, section 10): stiffer, and the body had moved less.
void add_ground_spring(const RivalSetting& setting, ModelParts& parts) {
  const Body& held = setting.device.bodies[setting.device.loop.held];
  const std::string key = "body." + held.name + ".stiffness";
  const std::vector<std::string> moving = moving_bodies_of(setting);
  if (held.stiffness > 0.0 || parts.has(key) || std::ranges::find(moving, held.name) == moving.end()) return;
  parts.add({key, Number::Scale::not_negative, setting.rms_force / setting.rms_position, 0.0, spring_deviation});
}

}  // namespace

Rival ground_spring() { return {"ground_spring", add_ground_spring, RivalMeasure::stiffness, true}; }

}  // namespace zwidth::internal
