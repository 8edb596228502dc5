#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

// Of the rms position: 0.1 % is 10 um of a stroke of 1 cm, where rolling bearings and cables begin to slide (Armstrong-Helouvry
// et al. 1994: 1 to 50 um); a factor of 4.5 either way at one sigma.
constexpr double length_typical = 1e-3;
constexpr double length_deviation = 1.5;

/// The way on which dry friction bends before it slides (presliding_step()), the same for all bodies. A body with bent friction
/// is a spring for small motions: taken for Coulomb's, the energy of that spring counts as damping.
void add_presliding(const RivalSetting& setting, ModelParts& parts) {
  if (parts.terms.frictions.empty()) return;
  const std::string key = parts.add(
      {"presliding_length", Number::Scale::logarithmic, length_typical * setting.rms_position, 0.0, length_deviation});
  for (FrictionTerm& friction : parts.terms.frictions) friction.presliding_length = key;
}

}  // namespace

Rival presliding() { return {"presliding", add_presliding}; }

}  // namespace zwidth::internal
