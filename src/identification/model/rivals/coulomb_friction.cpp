#include "identification/model/number_keys.hpp"
#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// Of the rms force: what the bearings and transmissions of haptic devices come to, 1 to 10 % (docs/identification_method.md).
constexpr double friction_deviation = 0.1;

/// Coulomb's dry friction of each moving body, which sticks: |force| <= limit, = limit against the motion.
void add_coulomb_friction(const RivalSetting& setting, ModelParts& parts) {
  for (const std::string& body : moving_bodies_of(setting)) {
    const std::string key =
        parts.add({friction_key(body), Number::Scale::not_negative, setting.rms_force, 0.0, friction_deviation});
    parts.terms.frictions.push_back({body, key});
  }
}

}  // namespace

Rival coulomb_friction() { return {"coulomb_friction", add_coulomb_friction}; }

}  // namespace zwidth::internal
