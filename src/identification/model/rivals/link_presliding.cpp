#include "identification/model/number_keys.hpp"
#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

// Of what the link stretches from one turn to the next. A logarithm: a search from no friction would end at no length, where
// friction sticks and hardly explains what it does, or at one so long that it never slides.
constexpr double typical_link_length = 0.1;
constexpr double link_length_deviation = 1.5;  // a factor of 4.5 either way

/// The way on which a link's dry friction bends before it slides (presliding_step()): each has its own.
void add_link_presliding(const RivalSetting& setting, ModelParts& parts) {
  for (std::size_t i = 0; i < setting.link_strokes.size(); ++i) {
    const double unit = typical_link_length * setting.link_strokes[i];
    for (FrictionTerm& friction : parts.terms.frictions) {
      if (friction.number != link_friction_key(i) || unit <= 0.0) continue;
      friction.presliding_length =
          parts.add({link_presliding_key(i), Number::Scale::logarithmic, unit, 0.0, link_length_deviation});
    }
  }
}

}  // namespace

Rival link_presliding() { return {"link_presliding", add_link_presliding, RivalMeasure::length}; }

}  // namespace zwidth::internal
