#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "design/boundary_branch.hpp"
#include "zwidth/design/stable_region.hpp"

namespace zwidth::internal {

// One side of a stable interval of K while B varies.
struct RegionEdge {
  BoundaryKind kind = BoundaryKind::oscillation;
  std::size_t branch = 0;  // of an oscillation
};

// A stable interval of K while B varies: between two edges.
struct RegionCell {
  RegionEdge left;
  std::optional<RegionEdge> right;  // absent: unbounded
};

// A range of B over which the same cells lie side by side.
struct RegionSlab {
  double lower = 0.0;
  double upper = 0.0;
  std::vector<RegionCell> cells;  // by rising K
};

struct RegionStructure {
  RegionStructure(FilteredPlant plant, double velocity_filter_hz);

  struct EdgePoint {
    double stiffness = 0.0;
    double angle = 0.0;  // of an oscillation
  };
  [[nodiscard]] EdgePoint edge_at(const RegionEdge& edge, double damping) const;

  BoundaryCurve curve;
  std::vector<BoundaryBranch> branches;
  std::optional<double> nyquist;  // K of the Nyquist line at B = 0, where > 0
  std::optional<double> drift;    // K at which a pole passes z = 1, where > 0
  std::vector<RegionSlab> slabs;  // by rising B, one on the other from B = 0; nothing is stable above the last

 private:
  [[nodiscard]] std::vector<Strand> straight_strands(double top) const;
  [[nodiscard]] std::vector<double> levels(const std::vector<Strand>& strands) const;
  [[nodiscard]] std::vector<RegionCell> cells_at(double damping) const;
  [[nodiscard]] bool hold_at(const std::vector<RegionCell>& cells, double damping) const;
  void add_slab(double lower, double upper);
};

}  // namespace zwidth::internal
