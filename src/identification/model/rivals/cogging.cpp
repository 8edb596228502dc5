#include <cmath>

#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// a cos(n q) + b sin(n q): a motor's magnets pull towards its slots.
class CoggingLaw final : public ForceLaw {
 public:
  explicit CoggingLaw(double per_turn) : per_turn_(per_turn) {}
  [[nodiscard]] LawForce at(const LawState& state, const double* numbers) const override {
    const double cosine = std::cos(per_turn_ * state.position);
    const double sine = std::sin(per_turn_ * state.position);
    return {numbers[0] * cosine + numbers[1] * sine,
            per_turn_ * (numbers[1] * cosine - numbers[0] * sine),
            0.0,
            {cosine, sine}};
  }

 private:
  double per_turn_;
};

constexpr double cogging_deviation = 0.05;  // of the rms force: a motor with slots, unskewed. An assumption.

void add_cogging(const RivalSetting& setting, ModelParts& parts) {
  if (setting.device.motion != Motion::rotary || !setting.cogging_per_turn) return;
  const auto add = [&](const char* key) {
    return parts.add({key, Number::Scale::any, setting.rms_force, 0.0, cogging_deviation});
  };
  const std::string cosine = add("cogging.cosine");
  const std::string sine = add("cogging.sine");
  parts.terms.forces.push_back(
      {std::make_shared<CoggingLaw>(*setting.cogging_per_turn), actuated_body(setting), "", {cosine, sine}});
}

}  // namespace

Rival cogging() { return {"cogging", add_cogging}; }

}  // namespace zwidth::internal
