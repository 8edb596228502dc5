#include "design/region/branch_structure.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Node = RegionStructure::Node;

constexpr double far_apart_by_chords = 0.02;  // in shares of the greatest K

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

Node BranchStructure::at_damping(std::size_t branch, double damping) const {
  const std::vector<Node>& nodes = branches[branch].nodes();
  const bool rises = nodes.back().wall.damping > nodes.front().wall.damping;
  const auto after = std::ranges::partition_point(
      nodes, [&](const Node& node) { return rises ? node.wall.damping < damping : node.wall.damping > damping; });
  if (after == nodes.begin()) return nodes.front();
  if (after == nodes.end()) return nodes.back();
  if (after->wall.damping == damping) return *after;
  const Node& a = *(after - 1);
  const Node& b = *after;
  if (const auto found = found_between(a, b, damping)) return *found;
  const auto excess = [&](double share) { return between(a, b, share).wall.damping - damping; };
  std::uintmax_t steps = most_root_steps_on_branch;
  const auto [low, high] =
      boost::math::tools::toms748_solve(excess, 0.0, 1.0, a.wall.damping - damping, b.wall.damping - damping,
                                        boost::math::tools::eps_tolerance<double>(48), steps);
  const Node found = between(a, b, 0.5 * (low + high));
  return {found.angle, {found.wall.stiffness, damping}};
}

void BranchStructure::add_branch(std::vector<Node> nodes, BoundaryKind kind) {
  if (nodes.size() < 2) return;
  branches.emplace_back(std::move(nodes));
  kinds_.push_back(kind);
}

// Where one comes to be the stiffer one: looked for between all nodes of both, by the chords where these are far apart.
void BranchStructure::add_crossings(std::size_t first, std::size_t second, std::vector<double>& found) const {
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
    if (std::abs(here) < far_apart_by_chords * most_.stiffness) here = apart(places[i]);
    if (i > 0 && before * here < 0.0) {
      const double at_low = apart(places[i - 1]);
      const double at_high = apart(places[i]);
      if (at_low * at_high < 0.0) {
        std::uintmax_t steps = most_root_steps_on_branch;
        const auto [from, to] = boost::math::tools::toms748_solve(apart, places[i - 1], places[i], at_low, at_high,
                                                                  boost::math::tools::eps_tolerance<double>(48), steps);
        found.push_back(0.5 * (from + to));
      }
    }
    before = here;
  }
}

// Every B at which branches end or cross, from 0.
std::vector<double> BranchStructure::levels() const {
  std::vector<double> found{0.0};
  for (std::size_t i = 0; i < branches.size(); ++i) {
    found.push_back(branches[i].nodes().front().wall.damping);
    found.push_back(branches[i].nodes().back().wall.damping);
    for (std::size_t j = i + 1; j < branches.size(); ++j) add_crossings(i, j, found);
  }
  std::ranges::sort(found);
  const auto same = [this](double a, double b) { return b - a <= same_level_of_branches * most_.damping; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

std::vector<RegionCell> BranchStructure::cells_at(double damping) const {
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
  const StableAt is_stable = stable_at(damping);
  std::vector<RegionCell> cells;
  bool was_stable = false;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const double next = i + 1 < crossings.size() ? crossings[i + 1].stiffness : most_.stiffness;
    const bool stable = is_stable(0.5 * (crossings[i].stiffness + next));
    if (stable && !was_stable) cells.push_back({crossings[i].edge, std::nullopt});
    if (!stable && was_stable) cells.back().right = crossings[i].edge;
    was_stable = stable;
  }
  if (was_stable) throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::crossover_off_boundary});
  return cells;
}

void BranchStructure::find_slabs(const Progress& progress) {
  const std::vector<double> found = levels();
  for (std::size_t i = 1; i < found.size(); ++i) {
    tell(progress, static_cast<double>(i) / static_cast<double>(found.size()));
    std::vector<RegionCell> cells = cells_at(0.5 * (found[i - 1] + found[i]));
    if (!slabs.empty() && slabs.back().cells == cells) {
      slabs.back().upper = found[i];
    } else {
      slabs.push_back({found[i - 1], found[i], std::move(cells)});
    }
  }
  while (!slabs.empty() && slabs.back().cells.empty()) slabs.pop_back();
}

RegionStructure::EdgePoint BranchStructure::edge_at(const RegionEdge& edge, double damping) const {
  if (!is_curved(edge)) return {0.0, 0.0};
  const Node node = at_damping(edge.branch, damping);
  return {node.wall.stiffness, node.angle};
}

bool BranchStructure::is_curved(const RegionEdge& edge) const {
  return edge.kind != BoundaryKind::no_stiffness && edge.kind != BoundaryKind::no_damping;
}

std::vector<Node> BranchStructure::nodes_between(std::size_t branch, const Node& first, const Node& last) const {
  std::vector<Node> nodes = branches[branch].nodes();
  const bool rises = nodes.back().wall.damping > nodes.front().wall.damping;
  const double low = std::min(first.wall.damping, last.wall.damping);
  const double high = std::max(first.wall.damping, last.wall.damping);
  std::erase_if(nodes, [&](const Node& each) { return each.wall.damping <= low || each.wall.damping >= high; });
  if (rises != (last.wall.damping > first.wall.damping)) std::ranges::reverse(nodes);
  return nodes;
}

BoundaryPoint BranchStructure::stiffest_between(const BoundaryPoint& first, const BoundaryPoint& last) const {
  const Node from = node_of(first);
  const Node to = node_of(last);
  std::uintmax_t steps = most_root_steps_on_branch;
  const double part =
      boost::math::tools::brent_find_minima([&](double share) { return -between(from, to, share).wall.stiffness; }, 0.0,
                                            1.0, std::numeric_limits<double>::digits / 2, steps)
          .first;
  const Node found = between(from, to, part);
  return seen_at(found.wall, found.angle);
}

}  // namespace zwidth::internal
