#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

/// Of the record: two quartz clocks differ by 20 to 100 parts in a million, cheap ones by more. An assumption.
constexpr double clock_difference = 1e-4;
constexpr double delay_drift_deviation = 1.0;

/// The force comes later and later, or earlier: the clocks of the force and of the position differ. The number "loop.delay" is
/// the delay at a record's beginning, where both clocks agree.
void add_delay_drift(const RivalSetting& setting, ModelParts& parts) {
  parts.terms.drive.delay_drift =
      parts.add({key_of_delay_drift, Number::Scale::any, clock_difference * setting.duration, 0.0, delay_drift_deviation});
}

}  // namespace

Rival delay_drift() { return {"delay_drift", add_delay_drift, RivalMeasure::time}; }

}  // namespace zwidth::internal
