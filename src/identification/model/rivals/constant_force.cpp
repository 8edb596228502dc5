#include "identification/model/number_keys.hpp"
#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// A load that stays: weight, a drive's offset, the pull of a cable. Dry friction that differs between directions is Coulomb's
/// friction of the mean limit with such a force.
LawForce constant_force_law(const LawState& /*state*/, const double* numbers) { return {numbers[0], 0.0, 0.0, {1.0}}; }

/// Of the rms force: a load that a builder would still record with. An assumption.
constexpr double constant_deviation = 0.3;

void add_constant_forces(const RivalSetting& setting, ModelParts& parts) {
  for (std::size_t record = 0; record < setting.records; ++record) {
    const std::string key =
        parts.add({constant_force_key(record), Number::Scale::any, setting.rms_force, 0.0, constant_deviation});
    parts.terms.forces.push_back({constant_force_law, actuated_body(setting), {key}, record});
  }
}

}  // namespace

Rival constant_force() { return {"constant_force", add_constant_forces}; }

}  // namespace zwidth::internal
