#include "identification/model/rivals.hpp"

#include <cmath>
#include <memory>
#include <utility>

namespace zwidth::internal {
namespace {

using Scale = Number::Scale;

/// A force that acts throughout.
class ConstantForce : public ForceLaw {
 public:
  [[nodiscard]] LawForce at(const LawState&, const double* numbers) const override {
    return {numbers[0], 0.0, 0.0, {1.0}};
  }
};

/// -c |v| v.
class Drag : public ForceLaw {
 public:
  [[nodiscard]] LawForce at(const LawState& state, const double* numbers) const override {
    const double speed = std::abs(state.velocity);
    return {-numbers[0] * speed * state.velocity, 0.0, -2.0 * numbers[0] * speed, {-speed * state.velocity}};
  }
};

/// -d (share - 1/2) v: the damping at the record's middle is the device's.
class DriftingDamping : public ForceLaw {
 public:
  [[nodiscard]] LawForce at(const LawState& state, const double* numbers) const override {
    constexpr double middle = 0.5;
    const double weight = state.share - middle;
    return {-numbers[0] * weight * state.velocity, 0.0, -numbers[0] * weight, {-weight * state.velocity}};
  }
};

class Adding {
 public:
  explicit Adding(ModelParts& parts) : parts_(parts) {}

  std::string number(std::string key, Scale scale, double unit, double deviation) {
    parts_.numbers.push_back({key, scale, unit, 0.0, deviation});
    return key;
  }
  template <typename Law>
  void force(const std::string& body, std::string key, Scale scale, double unit, double deviation,
             std::optional<std::size_t> record = {}) {
    number(key, scale, unit, deviation);
    parts_.terms.forces.push_back({std::make_shared<Law>(), body, "", {std::move(key)}, record});
  }
  void friction(const std::string& body, double unit, double deviation) {
    parts_.terms.frictions.push_back({body, number("friction." + body, Scale::not_negative, unit, deviation)});
  }
  DriveTerm& drive() { return parts_.terms.drive; }

 private:
  ModelParts& parts_;
};

}  // namespace

void add_rivals(const RivalSetting& setting, ModelParts& parts) {
  constexpr double of_constant_force = 0.3;
  constexpr double of_friction = 0.1;
  constexpr double of_drag = 1.0;
  constexpr double of_drift = 0.3;
  constexpr double of_dead_band = 0.05;
  constexpr double of_saturation = 0.1;
  constexpr double of_lag = 4.0;  // squares of a sampling period
  constexpr double of_spring = 0.1;
  const std::string& actuated = setting.start.bodies[setting.start.loop.actuated].name;
  const std::string& held = setting.start.bodies[setting.start.loop.held].name;
  Adding add(parts);
  if (setting.frees_lag) add.number("actuator.time_constant", Scale::square, setting.sampling_period, of_lag);
  if (setting.frees_ground) {
    add.number("body." + held + ".stiffness", Scale::not_negative, of_spring * setting.force / setting.position, 1.0);
  }
  for (std::size_t record = 0; record < setting.records; ++record) {
    add.force<ConstantForce>(actuated, "constant_force." + std::to_string(record), Scale::any, setting.force,
                             of_constant_force, record);
  }
  for (const std::string& body : setting.moving) add.friction(body, setting.force, of_friction);
  for (const std::string& body : setting.moving) {
    add.force<Drag>(body, "drag." + body, Scale::any, setting.damping / setting.speed, of_drag);
  }
  add.force<DriftingDamping>(actuated, "damping_drift", Scale::any, setting.damping, of_drift);
  add.drive().dead_band = add.number("dead_band", Scale::not_negative, setting.force, of_dead_band);
  add.drive().saturation = add.number("saturation", Scale::not_negative, setting.force, of_saturation);
}

}  // namespace zwidth::internal
