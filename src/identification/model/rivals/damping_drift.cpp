#include <algorithm>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// -d b (share - 1/2) v: a body's damping b that changes by the share d from a record's beginning to its end, as grease warms.
LawForce damping_drift_law(const LawState& state, const double* numbers) {
  constexpr double middle = 0.5;
  const double gone = (state.share - middle) * state.velocity;
  const double drift = numbers[0];
  const double damping = numbers[1];
  return {-drift * damping * gone, 0.0, -drift * damping * (state.share - middle), {-damping * gone, -drift * gone}};
}

/// Over the record (docs/identification_method.md): a grease thins by 3 to 4 % a kelvin, and a motor that works hard warms by some kelvin.
constexpr double drift_deviation = 0.2;

/// All free dampings to the ground change alike: a record hardly tells whose does. A given one stays as given.
void add_damping_drift(const RivalSetting& setting, ModelParts& parts) {
  std::vector<std::pair<std::string, std::string>> bodies;
  for (const std::string& body : moving_bodies_of(setting)) {
    const std::string damping = "body." + body + ".damping";
    if (parts.has(damping)) bodies.emplace_back(body, damping);
  }
  if (bodies.empty()) return;
  const std::string drift = parts.add({key_of_damping_drift, Number::Scale::any, 1.0, 0.0, drift_deviation});
  for (const auto& [body, damping] : bodies) parts.terms.forces.push_back({damping_drift_law, body, {drift, damping}});
}

}  // namespace

Rival damping_drift() { return {"damping_drift", add_damping_drift, RivalMeasure::ratio}; }

}  // namespace zwidth::internal
