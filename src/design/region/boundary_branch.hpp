#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "design/region/boundary_segment.hpp"

namespace zwidth::internal {

// A stretch of the curve, by rising angle, along which B only rises or only falls.
class BoundaryBranch {
 public:
  struct Node {
    double angle = 0.0;
    WallPoint wall;
  };

  explicit BoundaryBranch(std::vector<Node> nodes) : nodes_(std::move(nodes)) {}

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] bool holds(double angle) const { return nodes_.front().angle <= angle && angle <= nodes_.back().angle; }

  // Where it has this B; the nearer end where it has not.
  [[nodiscard]] Node at_damping(const BoundaryCurve& curve, double damping) const;

 private:
  std::vector<Node> nodes_;
};

// The segments as branches, divided at the extrema of B.
std::vector<BoundaryBranch> boundary_branches(const BoundaryCurve& curve, std::span<const BoundarySegment> segments);

}  // namespace zwidth::internal
