#include <algorithm>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// -d b (share - 1/2) v: a body's damping b that changes by the share d from a record's beginning to its end, as grease warms.
/// Numbers: d, and b where that is free.
class DampingDriftLaw final : public ForceLaw {
 public:
  DampingDriftLaw(double damping, bool is_free) : damping_(damping), is_free_(is_free) {}
  [[nodiscard]] LawForce at(const LawState& state, const double* numbers) const override {
    constexpr double middle = 0.5;
    const double gone = state.share - middle;
    const double damping = is_free_ ? numbers[1] : damping_;
    const double drift = numbers[0];
    const double by_damping = is_free_ ? -drift * gone * state.velocity : 0.0;
    return {-drift * damping * gone * state.velocity,
            0.0,
            -drift * damping * gone,
            {-damping * gone * state.velocity, by_damping}};
  }

 private:
  double damping_;  ///< N s/m or N m s/rad
  bool is_free_;
};

/// A grease thins by 3 to 4 % a kelvin, and a motor that works hard warms by up to 10 K in a record: 30 % at one sigma.
constexpr double drift_deviation = 0.3;

/// All bodies' dampings to the ground change alike: a record hardly tells whose does.
void add_damping_drift(const RivalSetting& setting, ModelParts& parts) {
  const std::vector<std::string> moving = moving_bodies_of(setting);
  const std::string drift = parts.add({key_of_damping_drift, Number::Scale::any, 1.0, 0.0, drift_deviation});
  for (const Body& body : setting.device.bodies) {
    const std::string key = "body." + body.name + ".damping";
    const bool is_free = parts.has(key);
    if (std::ranges::find(moving, body.name) == moving.end() || (!is_free && !(body.damping > 0.0))) continue;
    std::vector<std::string> numbers = {drift};
    if (is_free) numbers.push_back(key);
    parts.terms.forces.push_back(
        {std::make_shared<DampingDriftLaw>(body.damping, is_free), body.name, "", std::move(numbers)});
  }
}

}  // namespace

Rival damping_drift() { return {"damping_drift", add_damping_drift}; }

}  // namespace zwidth::internal
