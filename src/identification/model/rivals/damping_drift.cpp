#include <algorithm>
#include <string_view>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// -d (share - 1/2) v: damping that changes by d from a record's beginning to its end, as grease warms.
class DampingDriftLaw final : public ForceLaw {
 public:
  [[nodiscard]] LawForce at(const LawState& state, const double* numbers) const override {
    constexpr double middle = 0.5;
    const double gone = state.share - middle;
    return {-numbers[0] * gone * state.velocity, 0.0, -numbers[0] * gone, {-gone * state.velocity}};
  }
};

/// Of the linear damping, over the record (theory, section 10).
constexpr double drift_deviation = 0.2;
constexpr const char* drift_key = "damping_drift";

void add_damping_drift(const RivalSetting& setting, ModelParts& parts) {
  const std::string key = parts.add({drift_key, Number::Scale::any, typical_damping(setting), 0.0, drift_deviation});
  parts.terms.forces.push_back({std::make_shared<DampingDriftLaw>(), actuated_body(setting), "", {key}});
}

}  // namespace

DeviceParameters at_record_end(DeviceParameters device, const std::vector<Number>& numbers, const Eigen::VectorXd& x) {
  const auto drift = std::ranges::find(numbers, std::string_view(drift_key), &Number::key);
  if (drift == numbers.end() || device.bodies.empty()) return device;
  constexpr double since_middle = 0.5;
  double& damping = device.bodies[device.loop.actuated].damping;
  damping = std::max(0.0, damping + since_middle * drift->value(x(drift - numbers.begin())));
  return device;
}

Rival damping_drift() { return {"damping_drift", add_damping_drift, RivalMeasure::damping}; }

}  // namespace zwidth::internal
