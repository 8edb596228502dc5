// The branches of a region of two rates: its chains, divided where B turns.

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "design/region/two_rate_structure.hpp"

namespace zwidth::internal {
namespace {

using Node = RegionStructure::Node;
using Eigen::Vector3d;

// In shares of the greatest B and K.
constexpr double level_height = 1e-7;
constexpr double level_length = 1e-2;

// The last of the nodes from that one on that are all at one B, over a stretch of K that counts; else that one.
std::size_t end_of_level(const std::vector<Node>& nodes, std::size_t first, const WallPoint& most) {
  const WallPoint& begin = nodes[first].wall;
  std::size_t last = first;
  while (last + 1 < nodes.size() &&
         std::abs(nodes[last + 1].wall.damping - begin.damping) <= level_height * most.damping) {
    ++last;
  }
  return std::abs(nodes[last].wall.stiffness - begin.stiffness) > level_length * most.stiffness ? last : first;
}

}  // namespace

// The slope of B at that part of the way between two nodes, along the way.
double TwoRateStructure::rise(const Node& first, const Node& last, double part) const {
  const Vector3d chord = (TwoRateCurve::place(last) - TwoRateCurve::place(first)).cwiseQuotient(curve_.scales);
  Node node = on_curve(first, last, part);
  // At z = -1 itself the tangent is that of its curve.
  if (first.angle != last.angle) node.angle = std::min(node.angle, std::numbers::pi - beside_nyquist);
  const Vector3d along = curve_.tangent(node);
  return along.dot(chord) >= 0.0 ? along(2) : -along(2);
}

// The point between two nodes, on either side of it, where B turns.
Node TwoRateStructure::turn_between(const Node& first, const Node& last) const {
  const auto slope = [&](double part) { return rise(first, last, part); };
  const double at_first = slope(0.0);
  const double at_last = slope(1.0);
  if (!(at_first * at_last < 0.0)) return on_curve(first, last, 0.5);
  std::uintmax_t steps = most_root_steps_on_branch;
  const auto [low, high] = boost::math::tools::toms748_solve(slope, 0.0, 1.0, at_first, at_last,
                                                             boost::math::tools::eps_tolerance<double>(45), steps);
  return on_curve(first, last, 0.5 * (low + high));
}

// The turn of B between an end and the node next to it, of which no chord tells: B goes on beyond the end, then back.
std::optional<Node> TwoRateStructure::turn_beside(const Node& end, const Node& next) const {
  if (TwoRateCurve::is_straight(end)) return std::nullopt;
  const double way = next.wall.damping - end.wall.damping;
  if (!(rise(end, next, 0.0) * way < 0.0)) return std::nullopt;
  const Node turn = turn_between(end, next);
  const double beyond = way > 0.0 ? end.wall.damping - turn.wall.damping : turn.wall.damping - end.wall.damping;
  return beyond > same_level_of_branches * most_.damping ? std::optional(turn) : std::nullopt;
}

// Divided at the extrema of B. A stretch along which B is the same to the drawing's digits is a branch at one level.
void TwoRateStructure::add_branches(TwoRateChain chain) {
  std::vector<Node>& nodes = chain.nodes;
  if (nodes.size() < 2) return;
  if (chain.is_closed) {  // it begins where B is greatest
    nodes.pop_back();
    const auto greatest = std::ranges::max_element(nodes, {}, [](const Node& each) { return each.wall.damping; });
    std::rotate(nodes.begin(), greatest, nodes.end());
    const Node turn = turn_between(nodes.back(), nodes[1]);
    nodes.front() = turn;
    nodes.push_back(turn);
  }
  std::size_t begin = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t last = end_of_level(nodes, i, most_);
    if (last == i) continue;
    const double level = 0.5 * (nodes[i].wall.damping + nodes[last].wall.damping);
    for (std::size_t k = i; k <= last; ++k) nodes[k].wall.damping = level;
    const auto at = [&](std::size_t k) { return nodes.begin() + static_cast<std::ptrdiff_t>(k); };
    add_monotonic({at(begin), at(i + 1)}, chain.kind);
    add_branch({at(i), at(last + 1)}, chain.kind);
    begin = i = last;
  }
  add_monotonic({nodes.begin() + static_cast<std::ptrdiff_t>(begin), nodes.end()}, chain.kind);
}

void TwoRateStructure::add_monotonic(std::vector<Node> nodes, BoundaryKind kind) {
  if (nodes.size() < 2) return;
  if (const auto turn = turn_beside(nodes.front(), nodes[1])) nodes.insert(nodes.begin() + 1, *turn);
  if (const auto turn = turn_beside(nodes.back(), nodes[nodes.size() - 2])) nodes.insert(nodes.end() - 1, *turn);
  std::vector<Node> part{nodes.front()};
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const bool turns = i + 1 < nodes.size() && (nodes[i].wall.damping > nodes[i - 1].wall.damping) !=
                                                   (nodes[i + 1].wall.damping > nodes[i].wall.damping);
    if (!turns) {
      part.push_back(nodes[i]);
      continue;
    }
    const Node turn = turn_between(nodes[i - 1], nodes[i + 1]);
    const bool is_top = nodes[i].wall.damping > nodes[i - 1].wall.damping;
    // Rounding may leave the node itself beyond.
    const bool is_beyond =
        is_top ? nodes[i].wall.damping >= turn.wall.damping : nodes[i].wall.damping <= turn.wall.damping;
    const double way =
        (TwoRateCurve::place(nodes[i + 1]) - TwoRateCurve::place(nodes[i - 1]))
            .cwiseQuotient(curve_.scales)
            .dot((TwoRateCurve::place(turn) - TwoRateCurve::place(nodes[i])).cwiseQuotient(curve_.scales));
    if (!is_beyond && way > 0.0) part.push_back(nodes[i]);
    part.push_back(turn);
    add_branch(std::move(part), kind);
    part = {turn};
    if (!is_beyond && way <= 0.0) part.push_back(nodes[i]);
  }
  add_branch(std::move(part), kind);
}

}  // namespace zwidth::internal
