#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

constexpr double spring_deviation = 1.0;

/// -k x on the held body: a hand that rests, a cable, a spring that the structure lacks. It is believed to be as stiff as the
/// force over the position allows (docs/identification_method.md): stiffer, and the body had moved less.
void add_ground_spring(const RivalSetting& setting, ModelParts& parts) {
  const auto held = moving_held_body(setting);
  if (!held || setting.device.bodies[setting.device.loop.held].stiffness > 0.0) return;
  const std::string key = "body." + *held + ".stiffness";
  if (!parts.has(key)) parts.add({key, Number::Scale::not_negative, typical_stiffness(setting), 0.0, spring_deviation});
}

}  // namespace

Rival ground_spring() { return {"ground_spring", add_ground_spring, RivalMeasure::stiffness, true}; }

}  // namespace zwidth::internal
