#include <algorithm>

#include "identification/model/number_keys.hpp"
#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// Of the rms force: belts, cables and gears lose 1 to 5 % of what they carry.
constexpr double link_friction_deviation = 0.05;

/// Dry friction between the two bodies of a link, beside its spring and damper, where both move. Taken for linear damping, it
/// makes the link lossier than it is for small motion.
void add_link_friction(const RivalSetting& setting, ModelParts& parts) {
  const std::vector<std::string> moving = moving_bodies_of(setting);
  const auto moves = [&](const std::string& body) { return std::ranges::find(moving, body) != moving.end(); };
  for (std::size_t i = 0; i < setting.device.links.size(); ++i) {
    const std::string& first = setting.device.bodies[setting.device.links[i].first].name;
    const std::string& second = setting.device.bodies[setting.device.links[i].second].name;
    if (!moves(first) || !moves(second)) continue;
    const std::string key =
        parts.add({link_friction_key(i), Number::Scale::not_negative, setting.rms_force, 0.0, link_friction_deviation});
    parts.terms.frictions.push_back({second, key, first});
  }
}

}  // namespace

Rival link_friction() { return {"link_friction", add_link_friction}; }

}  // namespace zwidth::internal
