#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// -k2 q^2 - k3 q^3 on a body: a spring that stiffens (k3 > 0) or softens with its stroke. k2: where its middle is not at 0.
LawForce stiffening_spring_law(const LawState& state, const double* numbers) {
  const double q = state.position;
  const double square = q * q;
  return {-numbers[0] * square - numbers[1] * square * q,
          -2.0 * numbers[0] * q - 3.0 * numbers[1] * square,
          0.0,
          {-square, -square * q}};
}

/// As stiff at the rms position as the force over it allows, as ground_spring: stiffer, and the body had moved less.
constexpr double stiffening_deviation = 1.0;

void add_stiffening_spring(const RivalSetting& setting, ModelParts& parts) {
  const auto held = moving_held_body(setting);
  if (!held) return;
  const double unit = typical_stiffness(setting) / setting.rms_position;
  const auto add = [&](const char* key, double of) {
    return parts.add({key, Number::Scale::any, of, 0.0, stiffening_deviation});
  };
  const std::string square = add("stiffening.square", unit);
  const std::string cube = add("stiffening.cube", unit / setting.rms_position);
  parts.terms.forces.push_back({stiffening_spring_law, *held, {square, cube}});
}

}  // namespace

Rival stiffening_spring() { return {"stiffening_spring", add_stiffening_spring, RivalMeasure::mixed}; }

}  // namespace zwidth::internal
