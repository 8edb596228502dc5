#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "design/region/boundary_branch.hpp"
#include "stability/limit/gain_crossings.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// One side of a stable interval of K while B varies.
struct RegionEdge {
  BoundaryKind kind = BoundaryKind::oscillation;
  std::size_t branch = 0;  // of an oscillation
  friend bool operator==(const RegionEdge&, const RegionEdge&) = default;
};

// A stable interval of K while B varies: between two edges.
struct RegionCell {
  RegionEdge left;
  std::optional<RegionEdge> right;  // absent: unbounded
  friend bool operator==(const RegionCell&, const RegionCell&) = default;
};

// A range of B over which the same cells lie side by side.
struct RegionSlab {
  double lower = 0.0;
  double upper = 0.0;
  std::vector<RegionCell> cells;  // by rising K
};

struct RegionStructure {
  // Of ranges of B into slabs.
  static constexpr std::size_t max_divisions = 600;

  // The cells are told by the branches at each B; those of every slab are confirmed by critical_stiffness(), which
  // knows no branch. Where it contradicts, it tells the cells everywhere.
  // Throws Error (did_not_converge) at the cap, and as boundary_segments() and critical_stiffness() do.
  RegionStructure(FilteredPlant plant, double velocity_filter_hz, const Progress& progress);

  struct EdgePoint {
    double stiffness = 0.0;
    double angle = 0.0;  // of an oscillation
  };
  [[nodiscard]] EdgePoint edge_at(const RegionEdge& edge, double damping) const;

  // What rounding of the angle makes of K and of B, at the most, along the branches up to about `stiffest` at this B.
  [[nodiscard]] WallPoint rounding_at(double damping, double stiffest) const;

  BoundaryCurve curve;
  bool proven = true;  // bounds, not estimates, say that no piece of boundary is missed
  std::vector<BoundaryBranch> branches;
  std::optional<double> nyquist;  // K of the Nyquist line at B = 0, where > 0
  std::optional<double> drift;    // K at which a pole passes z = 1, where > 0
  std::vector<RegionSlab> slabs;  // by rising B, one on the other from B = 0; nothing is stable above the last

 private:
  [[nodiscard]] std::vector<BoundarySegment> straight_segments(double top) const;
  [[nodiscard]] std::vector<double> levels(const std::vector<BoundarySegment>& segments, const Progress& progress);
  [[nodiscard]] std::vector<RegionCell> cells_at(double damping) const;
  [[nodiscard]] std::vector<RegionCell> cells_by_branches(double damping) const;
  [[nodiscard]] std::vector<RegionCell> cells_by_isolation(double damping) const;
  [[nodiscard]] bool agree(const std::vector<RegionCell>& cells, const std::vector<RegionCell>& others,
                           double damping) const;
  [[nodiscard]] bool agree_within(const std::vector<RegionCell>& cells, double lower, double upper) const;
  [[nodiscard]] double stiffest_of(const std::vector<RegionCell>& cells, double damping) const;
  void add_below(double lower, double upper, std::vector<RegionCell> cells);
  void add_slabs(double bottom, double top, const Progress& progress);
  void find_slabs(const std::vector<double>& found, const Progress& progress);
  [[nodiscard]] bool are_slabs_confirmed(const Progress& progress) const;

  GainCrossings by_damping_;  // of the damper alone
  bool by_branches_ = true;
  bool told_apart_ = true;  // no two pieces of boundary lie on one another
  std::size_t divisions_left_ = max_divisions;
};

}  // namespace zwidth::internal
