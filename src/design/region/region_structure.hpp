#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "design/region/boundary_branch.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/finding.hpp"

namespace zwidth::internal {

// One side of a stable interval of K while B varies.
struct RegionEdge {
  BoundaryKind kind = BoundaryKind::oscillation;
  std::size_t branch = 0;  // of an oscillation, and of whatever is curved
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

// The stable walls of a loop, whatever its rates: cells in slabs, and the curves that end them.
class RegionStructure {
 public:
  using Node = BoundaryBranch::Node;

  RegionStructure() = default;
  RegionStructure(const RegionStructure&) = delete;
  RegionStructure& operator=(const RegionStructure&) = delete;
  virtual ~RegionStructure() = default;

  struct EdgePoint {
    double stiffness = 0.0;
    double angle = 0.0;  // of an oscillation
  };
  [[nodiscard]] virtual EdgePoint edge_at(const RegionEdge& edge, double damping) const = 0;
  // Whether such an edge runs along a branch, and not straight.
  [[nodiscard]] virtual bool is_curved(const RegionEdge& edge) const = 0;
  // What happens on a branch.
  [[nodiscard]] virtual BoundaryKind kind_of(std::size_t) const { return BoundaryKind::oscillation; }
  // That share of the way along the curve between two of its nodes.
  [[nodiscard]] virtual Node between(const Node& from, const Node& to, double part) const = 0;
  // The branch's own nodes between two of its points, in that order.
  [[nodiscard]] virtual std::vector<Node> nodes_between(std::size_t branch, const Node& first,
                                                        const Node& last) const = 0;
  // Where the curve is stiffest between two of its points.
  [[nodiscard]] virtual BoundaryPoint stiffest_between(const BoundaryPoint& first, const BoundaryPoint& last) const = 0;

  // What rounding of the angle makes of K and of B, at the most, along the branches up to about `stiffest` at this B.
  [[nodiscard]] virtual WallPoint rounding_at(double damping, double stiffest) const = 0;

  // How the loop oscillates where a wall puts a pole on the unit circle.
  [[nodiscard]] virtual BoundaryPoint seen_at(const WallPoint& wall, double angle) const = 0;

  [[nodiscard]] virtual double period() const = 0;  // whose z = e^{j angle}
  [[nodiscard]] virtual double velocity_filter_hz() const = 0;

  // Why the walls are not known, where they are not: then there are no slabs.
  std::optional<Finding> refusal;
  bool proven = true;  // bounds, not estimates, say that no piece of boundary is missed
  std::vector<BoundaryBranch> branches;
  std::vector<RegionSlab> slabs;  // by rising B, one on the other from B = 0; nothing is stable above the last
};

}  // namespace zwidth::internal
