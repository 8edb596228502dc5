#include "design/region/boundary_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Node = BoundaryBranch::Node;

constexpr int max_depth = 16;

class BoundaryTracer {
 public:
  BoundaryTracer(const RegionStructure& structure, double deviation)
      : structure_(structure), adjacency_(structure), deviation_(deviation) {
    for (const RegionSlab& slab : structure.slabs) {
      for (const RegionCell& cell : slab.cells) {
        steps_left_ += 2;
        for (const RegionEdge& edge : {cell.left, *cell.right}) measure(edge, slab);
      }
    }
  }

  TracedBoundary trace(const EdgeEnd& start, std::vector<std::vector<bool>>& visited) {
    TracedBoundary traced;
    traced.component = adjacency_.component(start);
    EdgeEnd from = start;
    do {
      if (from.right) visited[from.slab][from.cell] = true;
      EdgeEnd to = from;
      to.top = !to.top;
      add_edge(traced.boundary, from, to);
      from = adjacency_.partner(to);
      joint_ = usual_joint;
      if (adjacency_.damping(to) == 0.0) {
        add(traced.boundary, BoundaryKind::no_damping, {plain(to), plain(from)});
      } else if (apart(place(to), place(from)) > joint_) {
        if (auto level = level_arc(to, from)) {
          add(traced.boundary, level->kind, std::move(level->points));
        } else {
          joint_ = rounding_near(to);
        }
      }
    } while (!(from == start) && steps_left_-- > 0);
    close(traced.boundary);
    traced.gap = gap_;
    return traced;
  }

 private:
  void measure(const RegionEdge& edge, const RegionSlab& slab) {
    const auto first = structure_.edge_at(edge, slab.lower);
    const auto last = structure_.edge_at(edge, slab.upper);
    stiffness_extent_ = std::max({stiffness_extent_, first.stiffness, last.stiffness});
    damping_extent_ = std::max(damping_extent_, slab.upper);
    if (!structure_.is_curved(edge)) return;
    const Node from{first.angle, {first.stiffness, slab.lower}};
    const Node to{last.angle, {last.stiffness, slab.upper}};
    for (const Node& node : structure_.nodes_between(edge.branch, from, to)) {
      stiffness_extent_ = std::max(stiffness_extent_, node.wall.stiffness);
    }
  }

  [[nodiscard]] WallPoint place(const EdgeEnd& end) const {
    return {adjacency_.point(end).stiffness, adjacency_.damping(end)};
  }

  [[nodiscard]] BoundaryPoint plain(const EdgeEnd& end) const {
    return {std::max(adjacency_.point(end).stiffness, 0.0), adjacency_.damping(end), std::nullopt, std::nullopt};
  }

  [[nodiscard]] BoundaryPoint at_angle(const WallPoint& wall, double angle) const {
    // K = 0 and B = 0 are met to rounding of the extent.
    const auto cleared = [](double value, double extent) { return value > rounding * extent ? value : 0.0; };
    return structure_.seen_at({cleared(wall.stiffness, stiffness_extent_), cleared(wall.damping, damping_extent_)},
                              angle);
  }

  // Distance of a wall from the chord, in shares of the extent.
  [[nodiscard]] double off_chord(const WallPoint& wall, const WallPoint& a, const WallPoint& b) const {
    const double x = (b.stiffness - a.stiffness) / stiffness_extent_;
    const double y = (b.damping - a.damping) / damping_extent_;
    const double px = (wall.stiffness - a.stiffness) / stiffness_extent_;
    const double py = (wall.damping - a.damping) / damping_extent_;
    const double length = std::hypot(x, y);
    return length > 0.0 ? std::abs(x * py - y * px) / length : std::hypot(px, py);
  }

  // Points between two nodes, without the first. Two looks, so that no inflection passes for a straight line.
  void refine(const Node& from, const Node& to, int depth, std::vector<BoundaryPoint>& points) const {
    const auto between = [&](double part) { return structure_.between(from, to, part); };
    const auto strays = [&](double part) { return off_chord(between(part).wall, from.wall, to.wall) > deviation_; };
    if (depth < max_depth && (strays(1.0 / 3.0) || strays(2.0 / 3.0))) {
      const Node middle = between(0.5);
      refine(from, middle, depth + 1, points);
      refine(middle, to, depth + 1, points);
      return;
    }
    points.push_back(at_angle(to.wall, to.angle));
  }

  [[nodiscard]] double apart(const WallPoint& a, const WallPoint& b) const {
    return std::hypot((a.stiffness - b.stiffness) / stiffness_extent_, (a.damping - b.damping) / damping_extent_);
  }

  // The curve from one end to the other.
  [[nodiscard]] std::vector<BoundaryPoint> curve_points(const EdgeEnd& from, const EdgeEnd& to) const {
    const auto node = [this](const EdgeEnd& end) {
      const auto point = adjacency_.point(end);
      return Node{point.angle, {point.stiffness, adjacency_.damping(end)}};
    };
    const Node first = node(from);
    const Node last = node(to);
    // The branch's own nodes keep sharp bends from being overlooked.
    std::vector<Node> stops{first};
    for (const Node& each : structure_.nodes_between(adjacency_.edge(from).branch, first, last)) {
      if (apart(each.wall, stops.back().wall) > spacing && apart(each.wall, last.wall) > spacing) stops.push_back(each);
    }
    stops.push_back(last);
    std::vector<BoundaryPoint> points{at_angle(first.wall, first.angle)};
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) refine(stops[i], stops[i + 1], 0, points);
    return points;
  }

  // How far apart rounding of the angle moves two routes to this end.
  [[nodiscard]] double rounding_near(const EdgeEnd& end) const {
    const WallPoint at = place(end);
    const WallPoint moved = structure_.rounding_at(at.damping, at.stiffness);
    return std::max(usual_joint, joined_roundings *
                                     std::hypot(moved.stiffness / stiffness_extent_, moved.damping / damping_extent_));
  }

  // From one end to the other along a branch of constant B: there the product of the loop's poles is 1, or a pole is on the
  // circle whatever K.
  [[nodiscard]] std::optional<BoundaryArc> level_arc(const EdgeEnd& from, const EdgeEnd& to) const {
    const double level = adjacency_.damping(from);
    for (std::size_t i = 0; i < structure_.branches.size(); ++i) {
      const std::vector<Node>& nodes = structure_.branches[i].nodes();
      const auto on_level = [&](const Node& node) { return std::abs(node.wall.damping - level) <= same_level * level; };
      if (!std::all_of(nodes.begin(), nodes.end(), on_level)) continue;
      const Node first = at_stiffness(nodes.front(), nodes.back(), adjacency_.point(from).stiffness);
      const Node last = at_stiffness(nodes.front(), nodes.back(), adjacency_.point(to).stiffness);
      if (apart(first.wall, place(from)) > usual_joint || apart(last.wall, place(to)) > usual_joint) continue;
      return BoundaryArc{structure_.kind_of(i), {at_angle(first.wall, first.angle), at_angle(last.wall, last.angle)}};
    }
    return std::nullopt;
  }

  // Where the curve between two nodes has this K, by halving.
  [[nodiscard]] Node at_stiffness(Node a, Node b, double stiffness) const {
    if (std::abs(a.wall.stiffness - stiffness) <= same_level * stiffness) return a;
    for (int i = 0; i < max_halvings; ++i) {
      const Node middle = structure_.between(a, b, 0.5);
      const bool beyond = (middle.wall.stiffness > stiffness) == (b.wall.stiffness > stiffness);
      (beyond ? b : a) = middle;
    }
    return b;
  }

  void add_edge(ClosedBoundary& boundary, const EdgeEnd& from, const EdgeEnd& to) {
    const BoundaryKind kind = adjacency_.edge(from).kind;
    if (structure_.is_curved(adjacency_.edge(from))) {
      add(boundary, kind, curve_points(from, to));
    } else if (kind == BoundaryKind::no_stiffness) {
      add(boundary, kind, {plain(from), plain(to)});
    } else {
      const auto end = [this](const EdgeEnd& each) {
        const auto point = adjacency_.point(each);
        return at_angle({point.stiffness, adjacency_.damping(each)}, point.angle);
      };
      add(boundary, kind, {end(from), end(to)});
    }
  }

  static WallPoint wall(const BoundaryPoint& point) { return {point.stiffness, point.damping}; }

  // Two routes to the same vertex differ by rounding.
  void join(BoundaryPoint& moved, const BoundaryPoint& fixed) {
    const double gap = apart(wall(moved), wall(fixed));
    if (gap > joint_) {
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::outline_not_closed});
    }
    gap_ = std::max(gap_, gap);
    moved.stiffness = fixed.stiffness;
    moved.damping = fixed.damping;
  }

  // Goes on with the last arc where the kind and the place are the same.
  void add(ClosedBoundary& boundary, BoundaryKind kind, std::vector<BoundaryPoint> points) {
    if (!boundary.arcs.empty()) join(points.front(), boundary.arcs.back().points.back());
    if (points.size() == 2 && apart(wall(points[0]), wall(points[1])) == 0.0) return;
    if (!boundary.arcs.empty() && continues(boundary.arcs.back(), kind, points.front())) {
      auto& last = boundary.arcs.back().points;
      if (!structure_.is_curved({kind, 0})) last.pop_back();
      last.insert(last.end(), points.begin() + 1, points.end());
    } else {
      boundary.arcs.push_back({kind, std::move(points)});
    }
  }

  // The last arc may be the start of the first.
  void close(ClosedBoundary& boundary) {
    if (boundary.arcs.empty()) return;
    join(boundary.arcs.back().points.back(), boundary.arcs.front().points.front());
    if (boundary.arcs.size() < 2) return;
    BoundaryArc& first = boundary.arcs.front();
    BoundaryArc& last = boundary.arcs.back();
    if (!continues(last, first.kind, first.points.front())) return;
    last.points.insert(last.points.end(), first.points.begin() + 1, first.points.end());
    first = std::move(last);
    boundary.arcs.pop_back();
  }

  [[nodiscard]] static bool continues(const BoundaryArc& arc, BoundaryKind kind, const BoundaryPoint& point) {
    constexpr double same_frequency = 1e-6;
    if (arc.kind != kind) return false;
    const BoundaryPoint& end = arc.points.back();
    return kind != BoundaryKind::oscillation ||
           std::abs(*end.frequency - *point.frequency) <= same_frequency * *point.frequency;
  }

  static constexpr double usual_joint = usual_vertex_error;  // of the extent: ends this far apart are one vertex
  static constexpr double joined_roundings = 4.0;            // of two routes, and of the level at which they meet
  static constexpr double same_level = 1e-9;
  static constexpr int max_halvings = 60;
  static constexpr double spacing = 1e-3;
  static constexpr double rounding = 1e-14;

  const RegionStructure& structure_;
  CellAdjacency adjacency_;
  double deviation_;
  double stiffness_extent_ = 0.0;
  double damping_extent_ = 0.0;
  std::size_t steps_left_ = 0;  // of tracing: every side once
  double joint_ = usual_joint;  // of the ends at hand, where rounding moves them further
  double gap_ = 0.0;            // the greatest joined
};

}  // namespace

std::vector<TracedBoundary> trace_boundaries(const RegionStructure& structure, double deviation) {
  BoundaryTracer tracer(structure, deviation);
  std::vector<std::vector<bool>> visited;
  for (const RegionSlab& slab : structure.slabs) visited.emplace_back(slab.cells.size(), false);
  std::vector<TracedBoundary> boundaries;
  // Every boundary goes up a right side somewhere.
  for (std::size_t slab = 0; slab < visited.size(); ++slab) {
    for (std::size_t cell = 0; cell < visited[slab].size(); ++cell) {
      if (!visited[slab][cell]) boundaries.push_back(tracer.trace({slab, cell, true, false}, visited));
    }
  }
  return boundaries;
}

}  // namespace zwidth::internal
