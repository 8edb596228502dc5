#include "design/region/boundary_branch.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "stability/loop/plant_fraction.hpp"

namespace zwidth::internal {
namespace {

using Node = BoundaryBranch::Node;

constexpr std::uintmax_t max_steps = 100;

Node node_at(const BoundaryCurve& curve, double x) {
  const double angle = angle_of(x);
  return {angle, curve.at(angle)};
}

// The extremum of B between two angles, the greatest where direction > 0, else the least.
Node extremum(const BoundaryCurve& curve, double begin, double end, int direction) {
  std::uintmax_t steps = max_steps;
  const double angle = boost::math::tools::brent_find_minima([&](double a) { return -direction * curve.at(a).damping; },
                                                             begin, end, std::numeric_limits<double>::digits / 2, steps)
                           .first;
  return {angle, curve.at(angle)};
}

// Collects the nodes of one branch after another.
class BranchBuilder {
 public:
  explicit BranchBuilder(const BoundaryCurve& curve) : curve_(curve) {}

  void add(const BoundarySegment& segment) {
    if (!segment.follows) {
      finish();
      nodes_ = {node_at(curve_, segment.begin)};
    }
    end_ = segment.end;
    const int sign = segment.damping_sign();
    if (sign == 0) return;
    const Node begin = node_at(curve_, segment.begin);
    if (direction_ == -sign) {
      const Node turn = extremum(curve_, nodes_.back().angle, begin.angle, direction_);
      nodes_.push_back(turn);
      branches.emplace_back(std::move(nodes_));
      nodes_ = {turn};
    }
    direction_ = sign;
    if (nodes_.back().angle < begin.angle) nodes_.push_back(begin);
    nodes_.push_back(node_at(curve_, segment.end));
  }

  void finish() {
    if (!nodes_.empty()) {
      const Node end = node_at(curve_, end_);
      if (nodes_.back().angle < end.angle) nodes_.push_back(end);
      branches.emplace_back(std::move(nodes_));
    }
    nodes_.clear();
    direction_ = 0;
  }

  std::vector<BoundaryBranch> branches;

 private:
  const BoundaryCurve& curve_;
  std::vector<Node> nodes_;
  double end_ = 0.0;   // x where the last segment ended
  int direction_ = 0;  // of B
};

}  // namespace

BoundaryBranch::Node BoundaryBranch::at_damping(const BoundaryCurve& curve, double damping) const {
  const bool rises = nodes_.back().wall.damping > nodes_.front().wall.damping;
  // The first node at or past the wanted B.
  const auto after = std::partition_point(nodes_.begin(), nodes_.end(), [&](const Node& node) {
    return rises ? node.wall.damping < damping : node.wall.damping > damping;
  });
  if (after == nodes_.begin()) return nodes_.front();
  if (after == nodes_.end()) return nodes_.back();
  if (after->wall.damping == damping) return *after;
  const auto before = after - 1;
  std::uintmax_t steps = max_steps;
  const auto excess = [&](double angle) { return curve.at(angle).damping - damping; };
  const auto close_enough = [](double a, double b) {
    return std::abs(b - a) <= 4.0 * std::numeric_limits<double>::epsilon() * std::abs(b);
  };
  const auto [low, high] =
      boost::math::tools::toms748_solve(excess, before->angle, after->angle, before->wall.damping - damping,
                                        after->wall.damping - damping, close_enough, steps);
  const double angle = 0.5 * (low + high);
  return {angle, curve.at(angle)};
}

std::vector<BoundaryBranch> boundary_branches(const BoundaryCurve& curve, std::span<const BoundarySegment> segments) {
  BranchBuilder builder(curve);
  for (const BoundarySegment& segment : segments) builder.add(segment);
  builder.finish();
  return std::move(builder.branches);
}

}  // namespace zwidth::internal
