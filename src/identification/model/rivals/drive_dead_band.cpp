#include "identification/model/rivals/catalogue.hpp"

namespace zwidth::internal {
namespace {

constexpr double dead_band_deviation = 0.05;  // of the rms force (docs/identification_method.md)

/// The drive gives nothing below this command, and less by it above.
void add_drive_dead_band(const RivalSetting& setting, ModelParts& parts) {
  if (setting.has_one_size) return;
  parts.terms.drive.dead_band =
      parts.add({"dead_band", Number::Scale::not_negative, setting.rms_force, 0.0, dead_band_deviation});
}

}  // namespace

Rival drive_dead_band() { return {"drive_dead_band", add_drive_dead_band}; }

}  // namespace zwidth::internal
