#pragma once

#include <functional>

#include "zwidth/design/drive_damper.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

struct BestDamping {
  double damping = 0.0;
  double value = 0.0;
};

// The damping with the greatest value, from 0 to the largest that the damper may have alone whoever holds the device: looked at
// evenly in log B and refined where it is greatest. A local optimum.
[[nodiscard]] BestDamping best_damping(const Device& device, const std::function<double(double)>& value,
                                       const Progress& progress);

// The limit that is asked for with the damper on the drive and with it in the spring's loop, each at the B with the greatest limit
// over all passive users (of a device that cannot be held, of itself). Nothing as with_damper_on_drive(), and where a limit is not
// found or not finite.
[[nodiscard]] std::optional<DriveDamper> drive_damper(const Device& device, bool any_user, const Progress& progress);

// The finding of what is filled in, for a device of that motion.
[[nodiscard]] Finding finding_of(const DriveDamper& on_drive, Motion motion);

}  // namespace zwidth::internal
