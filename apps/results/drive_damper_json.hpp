#pragma once

#include "results/json.hpp"
#include "zwidth/design/drive_damper.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {

/// What the damper gains on the drive.
inline void to_json(Json& json, const DriveDamper& on_drive) {
  json = {{"parameter", on_drive.why.key},
          {"sampling_period_s", on_drive.sampling_period},
          {"delay_s", on_drive.delay},
          {"stiffness", on_drive.stiffness},
          {"damping", on_drive.damping},
          {"velocity_filter_hz", on_drive.velocity_filter_hz},
          {"any_user_critical_stiffness", on_drive.absolute_stability_limit},
          {"one_rate_stiffness", on_drive.one_rate_stiffness},
          {"one_rate_damping", on_drive.one_rate_damping},
          {"gain", on_drive.gain},
          {"text", text(on_drive.why)}};
}

}  // namespace zwidth::results
