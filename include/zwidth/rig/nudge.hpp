#pragma once

#include <optional>
#include <span>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// How a device moved under a force that is open to both sides of it.
enum class NudgeReading {
  with_force,     ///< a force pushes it the way that positions count
  against_force,  ///< the other way: a wall would push it away
  not_told        ///< it hardly moved, or otherwise than under that force
};

/// A push forwards, back and forwards again before any wall, and what came of it.
struct Nudge {
  double force = 0.0;                             ///< N or N m, the size of the push
  double moved = 0.0;                             ///< m or rad, along the force; negative: against it
  NudgeReading reading = NudgeReading::not_told;  ///< what that says of the signs
  std::optional<double> mending_force_sign =
      {};  ///< driver.force_sign that puts it right; absent: nothing to put right
};

/// The force of a nudge, sample by sample: a quarter each forwards, twice back and forwards, so that nothing drifts; then
/// as long none.
///
///     f = F (1, -1, -1, 1), each for a quarter of a period of the predicted limit's oscillation, two samples at least
///
/// `force` in N or N m, > 0.
[[nodiscard]] std::vector<double> nudge_force(const Device& device, double force);

/// Reads a nudge: positions (m or rad) under nudge_force(), at each sample.
///
///     r = <p, x> / (|p| |x|),   moved = <p, x> / <p, p> max |p|
///
/// p the positions of the device's file under the same force, both without mean and drift. Told where |r| is at least 0.7
/// and the device moved by four steps of its encoder; and where it moved otherwise, with damping that the file does not know,
/// by the way that the first push moved it, where it came back at the end. A file that is wrong by some factor changes
/// `moved` alone.
/// Throws Error as HybridLoop does.
[[nodiscard]] Nudge read_nudge(const Device& device, std::span<const double> force, std::span<const double> position);

}  // namespace zwidth
