#pragma once

#include <functional>

#include "zwidth/design/drive_damper.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

struct BestDamping {
  double damping = 0.0;
  double value = 0.0;
};

// The damping with the greatest value, from 0 to the largest that the damper may have alone whoever holds the device: sampled
// evenly in log B and refined beside the best sample. A local optimum.
[[nodiscard]] BestDamping best_damping(const Device& device, const std::function<double(double)>& value,
                                       const Progress& progress);

// The limit with the damper on the drive and with it in the spring's loop, each at the B with the greatest limit over all passive
// users; of a device that cannot be held, the greatest limit of nobody. `any_user`: which limit is given. Nothing where
// with_damper_on_drive() gives nothing, and where a limit is not found or not finite.
[[nodiscard]] std::optional<DriveDamper> drive_damper(const Device& device, bool any_user, const Progress& progress);

// Fills in the damper's timing on that device, the gain and the finding, from the stiffnesses and dampings that are there.
void complete(DriveDamper& found, const Device& on_drive);

}  // namespace zwidth::internal
