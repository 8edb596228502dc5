#pragma once

#include <optional>

#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth {

/// Hz, at which a drive closes its velocity loop: what a damper on the drive is taken to run at.
inline constexpr double usual_drive_rate = 8000.0;

/// What a device gains where its drive closes the damper in a loop of its own, [loop.damper].
struct DriveDamper {
  double sampling_period = 0.0;     ///< of the damper, s
  double delay = 0.0;               ///< of the damper's force, s, in addition to the zero-order hold
  double damping = 0.0;             ///< B that it is given with
  double velocity_filter_hz = 0.0;  ///< behind this filter; 0: none
  /// K with it: of a recommendation the wall, which keeps the same margins; of a target the limit asked for
  double stiffness = 0.0;
  /// The limit over all passive users at this B; infinite where nobody can destabilise a wall, absent where the device cannot be held
  std::optional<double> absolute_stability_limit = {};
  double one_rate_damping =
      0.0;  ///< the best B with the damper in the spring's loop; of a recommendation that of its wall
  double one_rate_stiffness = 0.0;  ///< K with it, as `stiffness`
  double gain = 1.0;                ///< stiffness by one_rate_stiffness
  Finding why;                      ///< the same as a finding of key "loop.damper.sampling_period"
};

/// The same device whose damper runs on the drive: its period is of the whole parts of the loop's the one nearest to that of
/// usual_drive_rate, its delay one such period and what the loop's own delay is beyond whole ones,
///
///     T_v = T/N,   N = round(8000 T),   t_v = T_v + (t_d mod T_v)
///
/// so that spring and damper see the aliases with one phase, as the limit over all passive users needs it. A drive's delay is not
/// known from the loop's: this one is taken, no measurement.
/// Nothing where the loop runs nearly as fast, has a damper of its own rate or wall filters, which know one rate alone.
[[nodiscard]] std::optional<Device> with_damper_on_drive(const Device& device);

}  // namespace zwidth
