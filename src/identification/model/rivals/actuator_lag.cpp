#include "identification/model/rivals/catalogue.hpp"
#include "model/loop_keys.hpp"
namespace zwidth::internal {
namespace {

constexpr double lag_typical = 2e-3;   // s, of current loops and amplifiers (docs/identification_method.md)
constexpr double lag_deviation = 1.0;  // of (lag / 2 ms)^2

/// 1 / (tau s + 1) beside the delay, where that is free: the record tells delay + lag in the first order, each in the second.
void add_actuator_lag(const RivalSetting& setting, ModelParts& parts) {
  if (setting.frees_lag && !parts.has(key_of_lag))
    parts.add({key_of_lag, Number::Scale::square, lag_typical, 0.0, lag_deviation});
}

}  // namespace

Rival actuator_lag() { return {"actuator_lag", add_actuator_lag, RivalMeasure::time, true}; }

}  // namespace zwidth::internal
