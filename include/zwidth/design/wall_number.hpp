#pragma once

namespace zwidth {

/// Which number of a wall a limit is of.
enum class WallNumber {
  stiffness,  ///< K, with the damper as it is; N/m or N m/rad
  damping,    ///< B of a damper alone, K = 0; N s/m or N m s/rad
};

}  // namespace zwidth
