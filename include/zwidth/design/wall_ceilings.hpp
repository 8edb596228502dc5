#pragma once

#include <optional>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// Ceilings of stiffness and damping that may be used together: every wall of 0 < K <= stiffness and
/// 0 <= B <= damping is stable.
struct WallCeilings {
  enum class Basis {
    any_user,  ///< whoever holds the device
    device,    ///< the device as it is, with its own user if it has one
  };
  Basis basis = Basis::device;
  double limit = 0.0;          ///< K at B = 0 where stability ends: the any-user limit, or K_CR
  double damping_limit = 0.0;  ///< the least B at which some wall of 0 < K <= stiffness is not stable
  double stiffness = 0.0;      ///< safety factor times limit
  double damping = 0.0;        ///< safety factor times damping_limit
};

/// The ceilings with that safety factor on each.
///
/// A program may use the stiffness alone, the damping alone, or both, and any less of them: so the whole rectangle must
/// be stable. damping_limit is the lowest boundary of the region over 0 < K <= stiffness: of the any-user region
/// (any_user_region(), sampled over B) where any_user_limit() at B = 0 is above 0, else of stable_region(). The
/// device's own wall.damping is left out; its velocity filter and its filters stay in.
///
/// Nothing where no wall without a damper is stable, or every wall is: there is no ceiling.
/// Throws Error (invalid_argument) for a safety factor outside (0, 1).
[[nodiscard]] std::optional<WallCeilings> wall_ceilings(const Device& device, double safety_factor);

}  // namespace zwidth
