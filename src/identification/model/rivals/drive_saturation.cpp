#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

// Of the rms force (docs/identification_method.md). At no saturation the motion changes with nothing: a fit starts beside it.
constexpr double saturation_deviation = 0.1;
constexpr double saturation_start = 0.02;

/// The drive gives no more than the largest command less this.
void add_drive_saturation(const RivalSetting& setting, ModelParts& parts) {
  if (setting.has_one_size) return;
  parts.terms.drive.saturation = parts.add(
      {"saturation", Number::Scale::not_negative, setting.rms_force, 0.0, saturation_deviation, saturation_start});
}

}  // namespace

Rival drive_saturation() { return {"drive_saturation", add_drive_saturation}; }

}  // namespace zwidth::internal
