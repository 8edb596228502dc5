#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "zwidth/design/absolute_stability_region.hpp"
#include "zwidth/design/region_approximation.hpp"
#include "zwidth/design/shared_walls.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/force_per_count.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// How finely the region is traced.
struct RegionOptions {
  OutlineOptions outline = {};  ///< of the outline
  bool any_user = true;         ///< the walls that no passive user destabilises, where the device has a body to hold
  bool approximations = true;   ///< the formulas of the literature and how far each is off
  Progress progress = {};       ///< told how far the work is; ends it by throwing
};

/// Checks: outline.deviation above 0 and below 1.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RegionOptions& options);

/// A formula of the literature beside the exact region.
struct ComparedApproximation {
  RegionApproximation formula;  ///< of the literature
  ApproximationError error;     ///< of that formula, against the exact region
};

/// The walls of the device that nobody holds, beside those with the file's user.
struct NobodysRegion {
  bool bounded = true;                       ///< false where every wall is stable
  std::optional<StableWalls> walls;          ///< with the velocity filter and the filters of the device's wall
  StableRegion region;                       ///< of these
  std::vector<Mode> modes;                   ///< vibration modes, that its BoundaryPoint::limited_by numbers
  std::optional<Mode> suspended_rigid_body;  ///< where springs tie the device to ground
};

/// Every wall (K, B) that a device renders stably, with its file's user. Where it is refused (trust), no wall, region,
/// limit or formula is held.
struct WallRegion {
  /// Whether there is a region.
  enum class Status {
    bounded,      ///< the stiffest and the most damped stable wall are known
    none_stable,  ///< no wall is
    unbounded,    ///< every wall is: the force does not move what the wall senses
    refused,
  };
  Status status = Status::refused;      ///< refused until it has been checked
  std::optional<StableWalls> walls;     ///< with the device's velocity filter and filters; absent where refused
  StableRegion region;                  ///< of the device with the file's user; with nobody holding where there is none
  std::optional<NobodysRegion> nobody;  ///< with nobody holding; absent without an [operator]: `region` is that
  /// The walls to build on: those of both. Absent without an [operator], where `region` is that.
  std::optional<SharedWalls> shared;
  /// Absent unless asked for; for a transfer function, for a wall in every direction, with a damper slower than its spring, above most_bodies_for_absolute_stability, or where no wall is stable.
  std::optional<AbsoluteStabilityRegion> any_user;
  std::vector<ComparedApproximation> approximations;  ///< none for a transfer function, or unless asked for
  std::optional<ForcePerCountRates> force_per_count;  ///< of any wall here; absent without an encoder resolution
  HoldingLimits limits;                      ///< on K at the device's own damper; any user where he is asked for
  std::vector<Mode> modes;                   ///< vibration modes, that BoundaryPoint::limited_by numbers
  std::optional<Mode> suspended_rigid_body;  ///< where springs tie the device to ground
  Trust trust;                               ///< the device's, and what the check of the walls found
  std::vector<Remark> remarks;               ///< how the walls were checked, what was left out
};

/// The region of a device, with the velocity filter and the filters of its wall: the entry point.
///
/// The boundary is that of stable_region(). Walls inside and outside, over the whole extent and on both sides of the
/// boundary, are then asked of a second route that shares nothing with it: matrix exponential and closed-loop poles.
/// Where the two contradict, where the boundary cannot be followed or does not close, or where the device's own numbers
/// are refused (trust_of()), the answer is `refused`; what is doubtful stays so. A device with an [operator] has two
/// regions, each checked so: a person lets go, and a wall must be stable with nobody holding too. The device's
/// wall.stiffness and wall.damping are left out.
/// Of a wall in every direction (is_point_wall()) the boundary is sampled, modes and formulas are empty, any user is left out.
/// Throws Error (invalid_argument) where find_problem() finds one, and for such a wall behind filters or with a damper in a
/// loop of its own.
[[nodiscard]] WallRegion region(const Device& device, const RegionOptions& options = {});

/// A region by walls: those of a grid, each stable or not.
struct WallRaster {
  std::vector<double> stiffnesses;  ///< K, rising
  std::vector<double> dampings;     ///< B, rising
  /// Element i * stiffnesses.size() + j: 1 where the wall (stiffnesses[j], dampings[i]) is stable with nobody and with
  /// the file's user, else 0.
  std::vector<std::uint8_t> stable;
};

/// `count` values of K and as many of B, the middles of equal cells over the region's extent and a tenth beyond; empty
/// unless the region, with the file's user where there is one, is bounded. Throws Error (invalid_argument) for a count
/// of 0.
[[nodiscard]] WallRaster wall_raster(const WallRegion& region, std::size_t count);

}  // namespace zwidth
