#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What something that a structure has no number for adds to the sensed position of a record, of unit size.
struct SuspectedMotion {
  enum class Kind : std::uint8_t {
    clock_skew,        ///< a delay that grows: (t - middle) dy/dt, of 1 s a second
    link_friction,     ///< a force between the bodies of a link that opposes their relative motion, of 1 N or N m
    changing_damping,  ///< a body's is 1 N s/m or N m s/rad more after a share of the record than before, 0 in the mean
  } kind = Kind::clock_skew;
  std::vector<double> motion;  ///< by sample
  std::string body = {};       ///< of a damping
  double share = 0.0;          ///< of the record, before a damping changes
};

/// Of the clocks of force and position that run apart; and of each link that rubs, or of which the cable or belt gives before it
/// slips: at once, and over three lengths of its relative motion (Dahl 1968); and of each body whose damping changes, as it does
/// while a device warms up. As the linear device moves, `device` as it was in
/// the experiment.
[[nodiscard]] std::vector<SuspectedMotion> suspected_motions(const Device& device, std::span<const double> force,
                                                             std::span<const double> position);

}  // namespace zwidth::internal
