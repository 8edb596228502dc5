#include <algorithm>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// -k2 q^2 - k3 q^3 on a body: a spring that stiffens (k3 > 0) or softens with its stroke. k2: where its middle is not at 0.
class StiffeningSpringLaw final : public ForceLaw {
 public:
  [[nodiscard]] LawForce at(const LawState& state, const double* numbers) const override {
    const double q = state.position;
    const double square = q * q;
    return {-numbers[0] * square - numbers[1] * square * q,
            -2.0 * numbers[0] * q - 3.0 * numbers[1] * square,
            0.0,
            {-square, -square * q}};
  }
};

/// As stiff at the rms position as the force over it allows, as ground_spring: stiffer, and the body had moved less.
constexpr double stiffening_deviation = 1.0;

void add_stiffening_spring(const RivalSetting& setting, ModelParts& parts) {
  const std::string& held = setting.device.bodies[setting.device.loop.held].name;
  const std::vector<std::string> moving = moving_bodies_of(setting);
  if (std::ranges::find(moving, held) == moving.end()) return;
  const double stiffness = setting.rms_force / setting.rms_position;
  const auto add = [&](const char* key, double unit) {
    return parts.add({key, Number::Scale::any, unit, 0.0, stiffening_deviation});
  };
  const std::string square = add("stiffening.square", stiffness / setting.rms_position);
  const std::string cube = add("stiffening.cube", stiffness / (setting.rms_position * setting.rms_position));
  parts.terms.forces.push_back({std::make_shared<StiffeningSpringLaw>(), held, {square, cube}});
}

}  // namespace

Rival stiffening_spring() { return {"stiffening_spring", add_stiffening_spring, RivalMeasure::mixed}; }

}  // namespace zwidth::internal
