#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

// Of the rms position: 50 um of 5 mm, where rolling bearings and cables begin to slide (Armstrong-Helouvry et al. 1994: 1 to 50
// um). Below a hundredth of that nothing changes with it (PlayedDevice): a fit starts beside it.
constexpr double length_typical = 1e-2;
constexpr double length_deviation = 1.0;
constexpr double length_start = 0.1;

/// The way on which dry friction bends before it slides (presliding_step()), the same for all bodies. A body with bent friction
/// is a spring for small motions: taken for Coulomb's, what that spring stores counts as damping.
void add_presliding(const RivalSetting& setting, ModelParts& parts) {
  if (parts.terms.frictions.empty()) return;
  const std::string key = parts.add({"presliding_length", Number::Scale::not_negative,
                                     length_typical * setting.rms_position, 0.0, length_deviation, length_start});
  for (FrictionTerm& friction : parts.terms.frictions) friction.presliding_length = key;
}

}  // namespace

Rival presliding() { return {"presliding", add_presliding, RivalMeasure::length}; }

}  // namespace zwidth::internal
