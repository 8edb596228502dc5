#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "zwidth/progress.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

class StudyRun;

inline constexpr std::uint64_t least_region_units = 368;  ///< with fewer, no interval of the 1 % contour has both ends
inline constexpr std::uint64_t most_region_units = std::uint64_t{1} << 20U;  ///< of one call
inline constexpr std::size_t region_grid_points = 61;                        ///< dampings of the contours

/// The stiffest walls that one share of the units renders, by their damping.
struct RegionContour {
  double share = 0.0;             ///< of the units, at least
  std::vector<double> stiffness;  ///< K at each damping; 0: no wall suits so many, infinity: unbounded
  std::vector<double> lower;      ///< of its 95 % interval, whatever the distribution
  std::vector<double> upper;      ///< of its 95 % interval, whatever the distribution
};

/// What many units render: the walls (K, B) that are stable, with every softer one, on 99 %, 50 % and 1 % of them.
struct RegionContours {
  std::uint64_t units = 0;              ///< that were asked: the first ones of the study
  std::vector<double> dampings;         ///< B: 0 and equal steps, up to where the last contour has ended
  double damping_step = 0.0;            ///< between two of them nothing is stated
  std::vector<RegionContour> contours;  ///< by falling share; empty where the trust is refused
  Trust trust;                          ///< of the contours: the device's, and of every unit's answers
};

/// The contours of the share of units for which a wall is stable.
///
/// At each B of a grid every unit's K_CR is computed as by critical_stiffness(Device), with its own velocity filter and
/// filters: exact there. The contour of share s is the order statistic X_(ceil(n (1 - s))) of them. Walls that are stable only
/// above some stiffness do not count, so no share is too large. A unit without an answer renders no wall, and the
/// contours are doubtful then. Refused where the region of the device on paper is, or is empty or unbounded: it gives the
/// scale of B.
/// Throws Error (invalid_argument) for units out of range or more than the study has, and where wall.damping varies.
[[nodiscard]] RegionContours region_contours(const StudyRun& run, std::uint64_t units, const Progress& progress = {});

}  // namespace zwidth
