#include "design/region/point_structure.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "infinity.hpp"
#include "stability/tip/gain_march.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Node = RegionStructure::Node;

// B at which the extent is looked for, in units of the wall that is about as stiff as the tip within a sample.
constexpr double least_damping_of_extent = 1e-6;
constexpr double most_damping_of_extent = 1e4;
constexpr double to_next_damping = 1.6;
constexpr double beyond_stable_walls = 4.0;  // of the stiffest one seen
constexpr int most_curve_rounds = 6;
constexpr int even_levels = 8;  // of B, that intervals are asked at beside those of every slab
constexpr double same_crossing_stiffness = 1e-6;
constexpr double thin_cell = 1e-5;  // relative: nothing is asked within
constexpr double thin_slab = 1e-3;  // of the greatest B
constexpr double at_axes = 1e-9;    // of the extent
constexpr double rounding_of_angle = 4.0 * std::numeric_limits<double>::epsilon();
constexpr double share_of_walls = 0.6;  // of the progress

bool is_straight_line(const Node& a, const Node& b) {
  return a.angle == b.angle && (a.angle == 0.0 || a.angle == std::numbers::pi);
}

}  // namespace

PointStructure::PointStructure(const Device& device, const Progress& progress)
    : plant_(tip_of_point_wall(device)), wall_(device.parameters().wall), curve_(plant_, wall_.velocity_filter_hz) {
  proven = !curve_.is_seen();
  if (proven) {
    slabs.push_back({0.0, infinity, {{RegionEdge{BoundaryKind::no_stiffness, 0}, std::nullopt}}});
    return;
  }
  StagedProgress stages(progress);
  std::vector<double> angles;
  for (int round = 0; round < most_curve_rounds; ++round) {
    stages.next(share_of_walls);
    build(angles, stages.stage());
    stages.next(round == 0 ? 1.0 : share_of_walls);
    const std::vector<double> missed = missed_angles(stages.stage());
    if (refusal) {
      slabs.clear();
      branches.clear();
      return;
    }
    if (missed.empty()) {
      stages.done();
      return;
    }
    angles.insert(angles.end(), missed.begin(), missed.end());
  }
  throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::crossover_off_boundary});
}

BranchStructure::StableAt PointStructure::stable_at(double damping) const {
  Wall wall = wall_;
  wall.damping = damping;
  return [loop = stiffness_loop(plant_, wall)](double stiffness) { return is_stable(loop, stiffness / loop.unit); };
}

// The greatest B and K of stable walls, by chords of the curves at many B.
void PointStructure::find_extent(const std::vector<PointCurve::Curve>& curves, const Progress& progress) {
  const double unit = stiffness_loop(plant_, {}).unit;
  most_ = {};
  std::vector<double> dampings{0.0};
  for (double each = least_damping_of_extent; each < most_damping_of_extent; each *= to_next_damping) {
    dampings.push_back(each * unit * plant_.period);
  }
  for (std::size_t level = 0; level + 1 < dampings.size(); ++level) {
    tell(progress, static_cast<double>(level) / static_cast<double>(dampings.size()));
    const double damping = dampings[level];
    std::vector<double> crossings{0.0};
    for (const PointCurve::Curve& curve : curves) {
      for (std::size_t i = 1; i < curve.size(); ++i) {
        const WallPoint& a = curve[i - 1].wall;
        const WallPoint& b = curve[i].wall;
        if ((a.damping > damping) == (b.damping > damping) || !std::isfinite(a.damping + b.damping)) continue;
        const double stiffness = std::lerp(a.stiffness, b.stiffness, (damping - a.damping) / (b.damping - a.damping));
        if (stiffness > 0.0) crossings.push_back(stiffness);
      }
    }
    for (const double each : curve_.nyquist_stiffnesses()) {
      const double stiffness = each - damping * curve_.velocity_at_nyquist();
      if (stiffness > 0.0) crossings.push_back(stiffness);
    }
    for (const double each : curve_.drift_stiffnesses()) crossings.push_back(each);
    std::ranges::sort(crossings);
    const StableAt is_stable = stable_at(damping);
    for (std::size_t i = 1; i < crossings.size(); ++i) {
      if (!is_stable(0.5 * (crossings[i - 1] + crossings[i]))) continue;
      most_.stiffness = std::max(most_.stiffness, beyond_stable_walls * crossings[i]);
      most_.damping = dampings[level + 1];
    }
  }
}

Node PointStructure::at_angle(const Node& a, const Node& b, double angle) const {
  const double part = (angle - a.angle) / (b.angle - a.angle);
  const WallPoint guess{std::lerp(a.wall.stiffness, b.wall.stiffness, part),
                        std::lerp(a.wall.damping, b.wall.damping, part)};
  return {angle, curve_.wall_near(angle, guess, most_)};
}

Node PointStructure::between(const Node& from, const Node& to, double part) const {
  if (part == 0.0 || part == 1.0) return part == 0.0 ? from : to;
  const double angle = std::lerp(from.angle, to.angle, part);
  const bool is_at_end = std::max(from.angle, to.angle) == std::numbers::pi && from.angle != to.angle &&
                         std::numbers::pi - angle < PointCurve::beside_nyquist;
  if (from.angle != to.angle && !is_at_end && angle >= PointCurve::least_angle) return at_angle(from, to, angle);
  return {
      angle,
      {std::lerp(from.wall.stiffness, to.wall.stiffness, part), std::lerp(from.wall.damping, to.wall.damping, part)}};
}

// How far inside the extent, in shares of it; below 0 outside.
double PointStructure::within(const Node& node) const {
  const double stiffness = node.wall.stiffness / most_.stiffness;
  const double damping = node.wall.damping / most_.damping;
  return std::min({stiffness, damping, 1.0 - stiffness, 1.0 - damping});
}

// Where the curve leaves the extent between two of its nodes.
Node PointStructure::at_bound(const Node& inside, const Node& outside) const {
  const auto at = [&](double part) { return between(inside, outside, part); };
  std::uintmax_t steps = most_root_steps_on_branch;
  const auto [low, high] =
      boost::math::tools::toms748_solve([&](double part) { return within(at(part)); }, 0.0, 1.0, within(inside),
                                        within(outside), boost::math::tools::eps_tolerance<double>(50), steps);
  return cleared(at(0.5 * (low + high)));
}

// K = 0 and B = 0 are met to rounding.
Node PointStructure::cleared(Node node) const {
  if (std::abs(node.wall.stiffness) < at_axes * most_.stiffness) node.wall.stiffness = 0.0;
  if (std::abs(node.wall.damping) < at_axes * most_.damping) node.wall.damping = 0.0;
  return node;
}

// Its stretches within the extent.
void PointStructure::add_within(const PointCurve::Curve& curve) {
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const bool is_in = within(curve[i]) > 0.0;
    if (is_in && nodes.empty() && i > 0) nodes.push_back(at_bound(curve[i], curve[i - 1]));
    if (is_in) nodes.push_back(i == 0 ? cleared(curve[i]) : curve[i]);
    if (!is_in && !nodes.empty()) {
      nodes.push_back(at_bound(curve[i - 1], curve[i]));
      add_monotonic(nodes);
      nodes.clear();
    }
  }
  if (nodes.size() < 2) return;
  // At its end beside z = -1 it meets the straight line there.
  for (const double each : curve_.nyquist_stiffnesses()) {
    Node end = nodes.back();
    end.angle = std::numbers::pi;
    end.wall.stiffness = each - end.wall.damping * curve_.velocity_at_nyquist();
    if (std::abs(end.wall.stiffness - nodes.back().wall.stiffness) < at_axes * most_.stiffness) nodes.back() = end;
  }
  add_monotonic(nodes);
}

// The node where B turns beside the middle one.
Node PointStructure::turn_between(const Node& first, const Node& middle, const Node& last) const {
  const double side = middle.wall.damping > first.wall.damping ? -1.0 : 1.0;
  const auto at = [&](double angle) {
    return angle < middle.angle ? at_angle(first, middle, angle) : at_angle(middle, last, angle);
  };
  std::uintmax_t steps = most_root_steps_on_branch;
  const double angle =
      boost::math::tools::brent_find_minima([&](double a) { return side * at(a).wall.damping; }, first.angle,
                                            last.angle, std::numeric_limits<double>::digits, steps)
          .first;
  const Node turn = at(angle);
  return side * turn.wall.damping < side * middle.wall.damping ? turn : middle;
}

// Divided at the extrema of B.
void PointStructure::add_monotonic(const std::vector<Node>& nodes) {
  std::vector<Node> part{nodes.front()};
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const bool turns = i + 1 < nodes.size() && (nodes[i].wall.damping > part.back().wall.damping) !=
                                                   (nodes[i + 1].wall.damping > nodes[i].wall.damping);
    if (!turns) {
      part.push_back(nodes[i]);
      continue;
    }
    const Node turn = turn_between(nodes[i - 1], nodes[i], nodes[i + 1]);
    if (turn.angle > nodes[i].angle) part.push_back(nodes[i]);
    part.push_back(turn);
    add_branch(std::move(part), BoundaryKind::oscillation);
    part = {turn};
    if (turn.angle < nodes[i].angle) part.push_back(nodes[i]);
  }
  add_branch(std::move(part), BoundaryKind::oscillation);
}

void PointStructure::add_straight() {
  const double velocity = curve_.velocity_at_nyquist();
  for (const double stiffness : curve_.nyquist_stiffnesses()) {
    const auto at = [&](double damping) { return Node{std::numbers::pi, {stiffness - damping * velocity, damping}}; };
    const double lowest = std::max(0.0, (stiffness - most_.stiffness) / velocity);
    const double highest = std::min(most_.damping, stiffness / velocity);
    if (lowest < highest) add_branch({at(lowest), at(highest)}, BoundaryKind::nyquist);
  }
  for (const double stiffness : curve_.drift_stiffnesses()) {
    if (stiffness < most_.stiffness) {
      add_branch({{0.0, {stiffness, 0.0}}, {0.0, {stiffness, most_.damping}}}, BoundaryKind::drift);
    }
  }
}

void PointStructure::build(const std::vector<double>& angles, const Progress& progress) {
  branches.clear();
  kinds_.clear();
  slabs.clear();
  StagedProgress stages(progress);
  stages.next(0.5);
  const std::vector<PointCurve::Curve> curves = curve_.curves(angles);
  find_extent(curves, stages.stage());
  stages.next(1.0);
  if (most_.damping == 0.0) return;
  for (const PointCurve::Curve& each : curves) add_within(each);
  add_straight();
  find_slabs(stages.stage());
}

// What the cells say at one B beside the crossings that the intervals come to.
void PointStructure::compare(double damping, const std::vector<RegionCell>& cells, std::vector<double>& missed) {
  Wall wall = wall_;
  wall.damping = damping;
  const GainLoop loop = stiffness_loop(plant_, wall);
  const auto judge = [&](const GainLimit& found, double expected) {
    if (found.kind == GainLimit::Kind::not_determined) refusal = Finding{.code = FindingCode::poles_along_circle};
    const double stiffness = found.kind == GainLimit::Kind::crossing ? found.gain * loop.unit : 0.0;
    if (!refusal && std::abs(stiffness - expected) > same_crossing_stiffness * std::max(stiffness, expected)) {
      missed.push_back(found.angle);
    }
  };
  const bool is_from_zero = !cells.empty() && cells.front().left.kind == BoundaryKind::no_stiffness;
  judge(first_crossing(loop), is_from_zero ? edge_at(*cells.front().right, damping).stiffness : 0.0);
  for (const RegionCell& cell : cells) {
    if (refusal || cell.left.kind == BoundaryKind::no_stiffness) continue;
    const double lower = edge_at(cell.left, damping).stiffness;
    const double upper = edge_at(*cell.right, damping).stiffness;
    if (upper - lower < thin_cell * upper) continue;
    const double middle = 0.5 * (lower + upper) / loop.unit;
    judge(crossing_above(loop, middle), upper);
    judge(crossing_below(loop, middle), lower);
  }
}

std::vector<double> PointStructure::missed_angles(const Progress& progress) {
  std::vector<double> missed;
  std::vector<double> levels{0.0};
  const double top = slabs.empty() ? 0.0 : slabs.back().upper;
  for (const RegionSlab& slab : slabs) {
    // In a thin one a curve turns or passes so near that intervals hardly get past its pole.
    if (slab.upper - slab.lower > thin_slab * top) levels.push_back(0.5 * (slab.lower + slab.upper));
  }
  for (int i = 0; i < even_levels; ++i) levels.push_back(top * (i + 0.5) / even_levels);
  for (std::size_t i = 0; i < levels.size() && !refusal; ++i) {
    tell(progress, static_cast<double>(i) / static_cast<double>(levels.size()));
    const auto slab = std::ranges::find_if(slabs, [&](const RegionSlab& each) { return levels[i] < each.upper; });
    compare(levels[i], slab == slabs.end() ? std::vector<RegionCell>{} : slab->cells, missed);
  }
  return missed;
}

std::optional<Node> PointStructure::found_between(const Node& a, const Node& b, double damping) const {
  if (!is_straight_line(a, b)) return std::nullopt;
  return between(a, b, (damping - a.wall.damping) / (b.wall.damping - a.wall.damping));
}

// Beside a mode that hardly anything damps the curve runs far within few digits of the angle.
WallPoint PointStructure::rounding_at(double damping, double stiffest) const {
  WallPoint greatest;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const Node node = at_damping(i, damping);
    if (kinds_[i] != BoundaryKind::oscillation || node.wall.damping != damping) continue;
    if (node.wall.stiffness > 2.0 * stiffest) continue;
    const WallPoint moved = curve_.wall_near(node.angle * (1.0 - rounding_of_angle), node.wall, most_);
    greatest.stiffness = std::max(greatest.stiffness, std::abs(moved.stiffness - node.wall.stiffness));
    greatest.damping = std::max(greatest.damping, std::abs(moved.damping - node.wall.damping));
  }
  return greatest;
}

Node PointStructure::node_of(const BoundaryPoint& point) const {
  return {std::min(*point.frequency * period(), std::numbers::pi), {point.stiffness, point.damping}};
}

BoundaryPoint PointStructure::seen_at(const WallPoint& wall, double angle) const {
  return {wall.stiffness, wall.damping, angle / period(), std::nullopt};
}

}  // namespace zwidth::internal
