#pragma once

#include <optional>

#include "zwidth/design/safe_wall.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {

/// Where the stiffness of a wall that is to run comes from: one of these, or the device's own wall.stiffness.
struct WallToRunOptions {
  std::optional<double> stiffness = {};      ///< K, N/m or N m/rad; > 0
  std::optional<double> safety_factor = {};  ///< share of the limit, as SafeWallOptions
  bool accept_doubt = false;                 ///< a doubtful device's wall may run too
};

/// Checks both numbers, that not both are given, and that the device has a wall where neither is.
[[nodiscard]] std::optional<OptionProblem> find_problem(const WallToRunOptions& options, const Device& device);

/// A wall to be written as a program, or run.
struct WallToRun {
  Device device;                       ///< with wall.stiffness; as it was where `share` found no wall
  Analysis analysis = {};              ///< of that device; its trust is the chosen share's too
  std::optional<SafeWall> share = {};  ///< how the stiffness was chosen, with a safety factor
  /// The wall may run: there is one, nothing is refused, and what is doubtful is accepted.
  bool released = false;
};

/// Decides on the wall that is to run and judges it.
///
///     K = stiffness,  safe_wall() of the safety factor,  or wall.stiffness
///
/// An unstable wall is released: it may be what is to be shown. analysis.wall_stable_for says with whom it is: a wall that
/// is to run must be stable with nobody and with the file's user.
/// Throws Error (invalid_argument) where find_problem() finds one, and as analyze() and safe_wall() do.
[[nodiscard]] WallToRun wall_to_run(const Device& device, const WallToRunOptions& options = {});

}  // namespace zwidth
