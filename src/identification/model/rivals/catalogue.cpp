#include "identification/model/rivals/catalogue.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

/// What each that is `wanted` adds, in their order.
template <class Wanted>
std::vector<AddedRival> add_each(const RivalSetting& setting, ModelParts& parts, Wanted wanted) {
  std::vector<AddedRival> added;
  for (const Rival& rival : rivals()) {
    if (!wanted(rival)) continue;
    const std::size_t before = parts.numbers.size();
    rival.add(setting, parts);
    AddedRival each{rival.code, {}, rival.measure};
    for (std::size_t i = before; i < parts.numbers.size(); ++i) each.keys.push_back(parts.numbers[i].key);
    if (!each.keys.empty()) added.push_back(std::move(each));
  }
  return added;
}

}  // namespace

std::span<const Rival> rivals() {
  static const std::array all = {
      constant_force(), coulomb_friction(), presliding(),   link_friction(), link_presliding(),   drag(),
      damping_drift(),  delay_drift(),      actuator_lag(), ground_spring(), stiffening_spring(), drive_saturation(),
      drive_dead_band()};
  return all;
}

std::vector<AddedRival> add_rivals(const RivalSetting& setting, ModelParts& parts) {
  std::vector<AddedRival> added = add_each(setting, parts, [](const Rival&) { return true; });
  const auto others = std::stable_partition(parts.numbers.begin(), parts.numbers.end(), [&](const Number& number) {
    return parameter(setting.device, number.key).has_value();
  });
  std::stable_partition(others, parts.numbers.end(), [](const Number& number) {
    return number.key == key_of_damping_drift || number.key == key_of_delay_drift;
  });
  return added;
}

std::vector<AddedRival> add_linear_rivals(const RivalSetting& setting, ModelParts& parts) {
  return add_each(setting, parts, [](const Rival& rival) { return rival.is_linear; });
}

}  // namespace zwidth::internal
