#include "design/region/two_rate_structure.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "infinity.hpp"
#include "stability/limit/mechanism_at.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Node = RegionStructure::Node;
using Eigen::Vector3d;

constexpr double full_turn = 2.0 * std::numbers::pi;
constexpr double share_of_slices = 0.3;  // of the progress
constexpr double share_of_chains = 0.6;
constexpr int more_slices = 3;
// In shares of the greatest B and K.
constexpr double clear_of_edge = 1e-6;
constexpr double beside_chord = 0.05;
constexpr double far_apart = 0.02;

// A branch by its chords.
struct Polyline {
  std::vector<WallPoint> walls;  // by rising B

  explicit Polyline(const std::vector<Node>& nodes) {
    for (const Node& each : nodes) walls.push_back(each.wall);
    if (walls.front().damping > walls.back().damping) std::ranges::reverse(walls);
  }
  [[nodiscard]] double at(double damping) const {
    const auto after =
        std::ranges::partition_point(walls, [&](const WallPoint& each) { return each.damping < damping; });
    if (after == walls.begin()) return walls.front().stiffness;
    if (after == walls.end()) return walls.back().stiffness;
    const WallPoint& before = *(after - 1);
    return std::lerp(before.stiffness, after->stiffness,
                     (damping - before.damping) / (after->damping - before.damping));
  }
};

}  // namespace

TwoRateStructure::TwoRateStructure(const Device& device, const Progress& progress) : curve_(device) {
  proven = !curve_.is_seen();
  if (proven) {
    slabs.push_back({0.0, infinity, {{RegionEdge{BoundaryKind::no_stiffness, 0}, std::nullopt}}});
    return;
  }
  try {
    build(1, progress);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    build(more_slices, progress);
  }
}

void TwoRateStructure::build(int density, const Progress& progress) {
  StagedProgress stages(progress);
  stages.next(share_of_slices);
  branches.clear();
  kinds_.clear();
  slabs.clear();
  slices_ = region_slices(curve_, density, stages.stage());
  if (slices_.most_outside == 0.0) {
    if (!is_stable_on_an_axis(curve_)) return;
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::region_changes_too_often});
  }
  most_ = curve_.wall(slices_.most_outside, slices_.most_inside);
  curve_.scales = {1.0, most_.stiffness, most_.damping};
  stages.next(share_of_chains);
  for (TwoRateChain& chain : trace_chains(curve_, slices_, density, stages.stage())) add_branches(std::move(chain));
  stages.next(1.0);
  const std::vector<double> found = levels();
  for (std::size_t i = 1; i < found.size(); ++i) {
    tell(stages.stage(), static_cast<double>(i) / static_cast<double>(found.size()));
    std::vector<RegionCell> cells = cells_at(0.5 * (found[i - 1] + found[i]));
    if (!slabs.empty() && slabs.back().cells == cells) {
      slabs.back().upper = found[i];
    } else {
      slabs.push_back({found[i - 1], found[i], std::move(cells)});
    }
  }
  while (!slabs.empty() && slabs.back().cells.empty()) slabs.pop_back();
  if (!std::ranges::all_of(slices_.slices, [this](const RegionSlice& slice) { return holds(slice); })) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::region_changes_too_often});
  }
  stages.done();
}

Node TwoRateStructure::between(const Node& from, const Node& to, double part) const {
  if (from.wall.damping != to.wall.damping) return on_curve(from, to, part);
  const Vector3d at =
      TwoRateCurve::place(from) + part * (TwoRateCurve::place(to) - TwoRateCurve::place(from));  // at one level
  return {at(0), {at(1), at(2)}};
}

Node TwoRateStructure::on_curve(const Node& from, const Node& to, double part) const {
  const Vector3d first = TwoRateCurve::place(from);
  const Vector3d way = TwoRateCurve::place(to) - first;
  const Vector3d at = first + part * way;
  const Node guess{at(0), {at(1), at(2)}};
  if (way.isZero(0.0) || TwoRateCurve::is_straight(from)) return guess;
  const double q = curve_.inside(guess.wall);
  if (std::min(from.angle, to.angle) == std::numbers::pi) return {guess.angle, curve_.wall(curve_.nyquist_gain(q), q)};
  if (part == 0.0 || part == 1.0) return part == 0.0 ? from : to;
  if (std::max(from.angle, to.angle) == std::numbers::pi) {
    // Walls move with the square of the angle from z = -1.
    const double left = from.angle == std::numbers::pi ? part : 1.0 - part;
    const double angle = std::numbers::pi - (std::numbers::pi - std::min(from.angle, to.angle)) * std::sqrt(left);
    if (std::numbers::pi - angle < beside_nyquist) return {angle, guess.wall};
    if (const auto found = curve_.solve({angle, guess.wall}, Vector3d::UnitX())) return *found;
  }
  const std::optional<Node> found = curve_.solve(guess, way.cwiseQuotient(curve_.scales).normalized());
  if (found) return *found;
  if (std::numbers::pi - guess.angle < beside_nyquist) return guess;
  throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::crossover_off_boundary});
}

Node TwoRateStructure::at_damping(std::size_t branch, double damping) const {
  const std::vector<Node>& nodes = branches[branch].nodes();
  const bool rises = nodes.back().wall.damping > nodes.front().wall.damping;
  const auto after = std::ranges::partition_point(
      nodes, [&](const Node& node) { return rises ? node.wall.damping < damping : node.wall.damping > damping; });
  if (after == nodes.begin()) return nodes.front();
  if (after == nodes.end()) return nodes.back();
  if (after->wall.damping == damping) return *after;
  const Node& a = *(after - 1);
  const Node& b = *after;
  const double part = (damping - a.wall.damping) / (b.wall.damping - a.wall.damping);
  if (a.angle != std::numbers::pi || b.angle != std::numbers::pi) {
    if (TwoRateCurve::is_straight(a)) return between(a, b, part);
    const Vector3d way = (TwoRateCurve::place(b) - TwoRateCurve::place(a)).cwiseQuotient(curve_.scales);
    const Vector3d at = TwoRateCurve::place(a) + part * (TwoRateCurve::place(b) - TwoRateCurve::place(a));
    if (const auto found = curve_.solve({at(0), {at(1), damping}}, Vector3d::UnitZ())) {
      const Vector3d moved = (TwoRateCurve::place(*found) - TwoRateCurve::place(a)).cwiseQuotient(curve_.scales);
      const double along = moved.dot(way) / way.squaredNorm();
      const double off = (moved - along * way).norm();
      if (along > -beside_chord && along < 1.0 + beside_chord && off < way.norm()) {
        return {found->angle, {found->wall.stiffness, damping}};
      }
    }
  }
  const auto excess = [&](double share) { return between(a, b, share).wall.damping - damping; };
  std::uintmax_t steps = most_root_steps_of_two_rates;
  const auto [low, high] =
      boost::math::tools::toms748_solve(excess, 0.0, 1.0, a.wall.damping - damping, b.wall.damping - damping,
                                        boost::math::tools::eps_tolerance<double>(48), steps);
  const Node found = between(a, b, 0.5 * (low + high));
  return {found.angle, {found.wall.stiffness, damping}};
}

// Where one comes to be the stiffer one: looked for between all nodes of both, by the chords where these are far apart.
void TwoRateStructure::add_crossings(std::size_t first, std::size_t second, std::vector<double>& found) const {
  const Polyline a(branches[first].nodes());
  const Polyline b(branches[second].nodes());
  const double low = std::max(a.walls.front().damping, b.walls.front().damping);
  const double high = std::min(a.walls.back().damping, b.walls.back().damping);
  if (!(low < high)) return;
  std::vector<double> places{low, high};
  for (const Polyline* each : {&a, &b}) {
    for (const WallPoint& wall : each->walls) {
      if (wall.damping > low && wall.damping < high) places.push_back(wall.damping);
    }
  }
  std::ranges::sort(places);
  const auto apart = [&](double damping) {
    return at_damping(first, damping).wall.stiffness - at_damping(second, damping).wall.stiffness;
  };
  double before = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    double here = a.at(places[i]) - b.at(places[i]);
    if (std::abs(here) < far_apart * most_.stiffness) here = apart(places[i]);
    if (i > 0 && before * here < 0.0) {
      const double at_low = apart(places[i - 1]);
      const double at_high = apart(places[i]);
      if (at_low * at_high < 0.0) {
        std::uintmax_t steps = most_root_steps_of_two_rates;
        const auto [from, to] = boost::math::tools::toms748_solve(apart, places[i - 1], places[i], at_low, at_high,
                                                                  boost::math::tools::eps_tolerance<double>(48), steps);
        found.push_back(0.5 * (from + to));
      }
    }
    before = here;
  }
}

// Every B at which branches end or cross, from 0.
std::vector<double> TwoRateStructure::levels() const {
  std::vector<double> found{0.0};
  for (std::size_t i = 0; i < branches.size(); ++i) {
    found.push_back(branches[i].nodes().front().wall.damping);
    found.push_back(branches[i].nodes().back().wall.damping);
    for (std::size_t j = i + 1; j < branches.size(); ++j) add_crossings(i, j, found);
  }
  std::ranges::sort(found);
  const auto same = [this](double a, double b) { return b - a <= same_level_of_two_rates * most_.damping; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

std::vector<RegionCell> TwoRateStructure::cells_at(double damping) const {
  struct Crossing {
    double stiffness;
    RegionEdge edge;
  };
  std::vector<Crossing> crossings{{0.0, {BoundaryKind::no_stiffness, 0}}};
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const double first = branches[i].nodes().front().wall.damping;
    const double last = branches[i].nodes().back().wall.damping;
    if ((first > damping) == (last > damping)) continue;
    crossings.push_back({at_damping(i, damping).wall.stiffness, {kinds_[i], i}});
  }
  std::ranges::sort(crossings, {}, &Crossing::stiffness);
  std::optional<RegionSlice> slice;
  if (curve_.is_damper_inside()) slice = region_slice(curve_, damping);
  std::vector<RegionCell> cells;
  bool was_stable = false;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const double next = i + 1 < crossings.size() ? crossings[i + 1].stiffness : most_.stiffness;
    const WallPoint middle{0.5 * (crossings[i].stiffness + next), damping};
    if (!curve_.is_damper_inside()) slice = region_slice(curve_, middle.stiffness);
    const bool stable = slice->is_stable(curve_.outside(middle));
    if (stable && !was_stable) cells.push_back({crossings[i].edge, std::nullopt});
    if (!stable && was_stable) cells.back().right = crossings[i].edge;
    was_stable = stable;
  }
  if (was_stable) throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::crossover_off_boundary});
  return cells;
}

// Whether the cells are what that slice says: between any two of its crossings.
bool TwoRateStructure::holds(const RegionSlice& slice) const {
  if (slice.inside >= slices_.most_inside) return true;
  double lower = 0.0;
  const double clear = clear_of_edge * slices_.most_outside;
  const auto agrees = [&](double upper) {
    const double outside = 0.5 * (lower + upper);
    const double height = upper - lower;
    lower = upper;
    if (height < clear || outside >= slices_.most_outside) return true;
    const WallPoint wall = curve_.wall(outside, slice.inside);
    const auto slab =
        std::ranges::partition_point(slabs, [&](const RegionSlab& each) { return each.upper <= wall.damping; });
    bool drawn = false;
    if (slab != slabs.end()) {
      for (const RegionCell& cell : slab->cells) {
        drawn = drawn || (wall.stiffness > edge_at(cell.left, wall.damping).stiffness &&
                          wall.stiffness < edge_at(*cell.right, wall.damping).stiffness);
      }
    }
    return drawn == slice.is_stable(outside);
  };
  for (const GainCrossing& each : slice.found.crossings) {
    if (!agrees(each.gain)) return false;
  }
  return lower >= slices_.most_outside || agrees(slices_.most_outside);
}

RegionStructure::EdgePoint TwoRateStructure::edge_at(const RegionEdge& edge, double damping) const {
  if (!is_curved(edge)) return {0.0, 0.0};
  const Node node = at_damping(edge.branch, damping);
  return {node.wall.stiffness, node.angle};
}

bool TwoRateStructure::is_curved(const RegionEdge& edge) const {
  return edge.kind != BoundaryKind::no_stiffness && edge.kind != BoundaryKind::no_damping;
}

std::vector<Node> TwoRateStructure::nodes_between(std::size_t branch, const Node& first, const Node& last) const {
  std::vector<Node> nodes = branches[branch].nodes();
  const bool rises = nodes.back().wall.damping > nodes.front().wall.damping;
  const double low = std::min(first.wall.damping, last.wall.damping);
  const double high = std::max(first.wall.damping, last.wall.damping);
  std::erase_if(nodes, [&](const Node& each) { return each.wall.damping <= low || each.wall.damping >= high; });
  if (rises != (last.wall.damping > first.wall.damping)) std::ranges::reverse(nodes);
  return nodes;
}

Node TwoRateStructure::node_of(const BoundaryPoint& point) const {
  const double turned = std::fmod(*point.frequency * period(), full_turn);
  return {std::min(turned, full_turn - turned), {point.stiffness, point.damping}};
}

BoundaryPoint TwoRateStructure::stiffest_between(const BoundaryPoint& first, const BoundaryPoint& last) const {
  const Node from = node_of(first);
  const Node to = node_of(last);
  std::uintmax_t steps = most_root_steps_of_two_rates;
  const double part =
      boost::math::tools::brent_find_minima([&](double share) { return -between(from, to, share).wall.stiffness; }, 0.0,
                                            1.0, std::numeric_limits<double>::digits / 2, steps)
          .first;
  const Node found = between(from, to, part);
  return seen_at(found.wall, found.angle);
}

BoundaryPoint TwoRateStructure::seen_at(const WallPoint& wall, double angle) const {
  const double frequency = angle > 0.0 ? curve_.frequency({angle, wall}) : 0.0;
  return {wall.stiffness, wall.damping, frequency,
          mechanism_at(curve_.modes(), std::min(frequency * curve_.spring_period(), std::numbers::pi))};
}

}  // namespace zwidth::internal
