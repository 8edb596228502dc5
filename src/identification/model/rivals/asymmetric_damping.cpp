#include <cmath>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// -a |v|: damping b + a forwards and b - a backwards. A dry friction that differs between directions needs no law of its own:
/// it is Coulomb's with a constant force.
class AsymmetricDampingLaw final : public ForceLaw {
 public:
  [[nodiscard]] LawForce at(const LawState& state, const double* numbers) const override {
    const double speed = std::abs(state.velocity);
    const double direction = state.velocity < 0.0 ? -1.0 : 1.0;
    return {-numbers[0] * speed, 0.0, -numbers[0] * direction, {-speed}};
  }
};

/// Of the linear damping: gears and cables that run easier one way. An assumption.
constexpr double asymmetry_deviation = 0.1;

void add_asymmetric_damping(const RivalSetting& setting, ModelParts& parts) {
  const std::string key =
      parts.add({"damping_asymmetry", Number::Scale::any, typical_damping(setting), 0.0, asymmetry_deviation});
  parts.terms.forces.push_back({std::make_shared<AsymmetricDampingLaw>(), actuated_body(setting), "", {key}});
}

}  // namespace

Rival asymmetric_damping() { return {"asymmetric_damping", add_asymmetric_damping, RivalMeasure::damping}; }

}  // namespace zwidth::internal
