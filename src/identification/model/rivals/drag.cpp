#include <cmath>

#include "identification/model/number_keys.hpp"
#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// -c |v| v. c < 0: friction that falls with speed, as Stribeck's does.
LawForce drag_law(const LawState& state, const double* numbers) {
  const double speed = std::abs(state.velocity);
  return {-numbers[0] * speed * state.velocity, 0.0, -2.0 * numbers[0] * speed, {-speed * state.velocity}};
}

/// As much as the linear damping at the record's largest speed (docs/identification_method.md).
constexpr double drag_deviation = 1.0;

void add_drag(const RivalSetting& setting, ModelParts& parts) {
  const double unit = typical_damping(setting) / setting.largest_speed;
  for (const std::string& body : moving_bodies_of(setting)) {
    const std::string key = parts.add({drag_key(body), Number::Scale::any, unit, 0.0, drag_deviation});
    parts.terms.forces.push_back({drag_law, body, {key}});
  }
}

}  // namespace

Rival drag() { return {"drag", add_drag, RivalMeasure::quadratic_damping}; }

}  // namespace zwidth::internal
