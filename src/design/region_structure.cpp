#include "design/region_structure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "design/boundary_crossings.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Levels of B closer than this, relative, are one.
constexpr double same_level = 1e-11;
// A slab is checked this share of its height from either end, and by this ratio of B between down to this share of its
// top; it is divided where it does not hold there, down to this height relative to B.
constexpr double guard_share = 1e-3;
constexpr double check_ratio = 8.0;
constexpr double lowest_share = 1e-15;
constexpr double least_height = 1e-9;
// The lowest slab is divided by this ratio, as far down as this share of the highest B.
constexpr double first_division = 32.0;
constexpr double least_level = 1e-16;
// Pieces of a straight line beyond its lowest, and the ratio of their ends.
constexpr int line_pieces = 30;
constexpr double line_ratio = 4.0;
// Two routes to one K agree to this share of |K| + |B|/T.
constexpr double same_stiffness = 1e-6;
// An angle this far, relative, outside a branch is on its end.
constexpr double same_angle = 1e-6;

// K = stiffness + slope B for 0 <= B <= top, in pieces by ratios of B: each knows B to rounding of itself.
void add_line(std::vector<BoundarySegment>& lines, double stiffness, double slope, double top) {
  double lower = 0.0;
  for (int i = line_pieces; i >= 0; --i) {
    const double upper = top * std::pow(line_ratio, -i);
    const double middle = 0.5 * (lower + upper);
    const double half = 0.5 * (upper - lower);
    BoundarySegment piece{{stiffness + slope * middle, slope * half, 0.0, 0.0}, {middle, half, 0.0, 0.0}, lower, upper};
    piece.straight = true;
    piece.follows = i < line_pieces;
    lines.push_back(piece);
    lower = upper;
  }
}

std::optional<double> if_positive(double value) {
  return value > 0.0 && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> drift_stiffness(const BoundaryCurve& curve) {
  const auto& terms = curve.plant().terms;
  if (std::any_of(terms.begin(), terms.end(), [](const SampledTerm& term) { return term.integrators > 0; })) return {};
  return if_positive(curve.at(0.0).stiffness);
}

}  // namespace

RegionStructure::RegionStructure(FilteredPlant plant, double velocity_filter_hz)
    : curve(std::move(plant), velocity_filter_hz) {
  if (curve.plant().terms.empty()) {  // the wall does not see the device
    const RegionCell all{RegionEdge{BoundaryKind::no_stiffness, 0}, std::nullopt};
    slabs.push_back({0.0, infinity, {all}});
    return;
  }
  nyquist = if_positive(curve.nyquist_stiffness());
  drift = drift_stiffness(curve);
  by_damping_ = damping_crossings(curve.plant(), {0.0, curve.velocity_filter_hz()});
  const auto [segments, all_proven] = curve_segments(curve, wall_bounds(curve));
  proven = all_proven;
  branches = boundary_branches(curve, segments);
  const std::vector<double> found = levels(segments);
  for (std::size_t i = found.size() - 1; i > 0; --i) {
    // Where everything meets at K = B = 0 rounding moves levels: what is below is not resolved.
    const double unresolved = slabs.empty() ? 0.0 : finest_detail * slabs.front().upper;
    add_slabs(found[i] > unresolved ? found[i - 1] : 0.0, found[i]);
    if (found[i] <= unresolved) break;
  }
  std::reverse(slabs.begin(), slabs.end());
}

std::vector<BoundarySegment> RegionStructure::straight_segments(double top) const {
  std::vector<BoundarySegment> lines;
  if (nyquist) {
    const double velocity = curve.velocity_at_nyquist();
    top = std::max(top, *nyquist / velocity);
    add_line(lines, *nyquist, -velocity, *nyquist / velocity);
  }
  add_line(lines, 0.0, 0.0, top);
  if (drift) add_line(lines, *drift, 0.0, top);
  return lines;
}

// Every B at which the stable intervals of K may change, from 0.
std::vector<double> RegionStructure::levels(const std::vector<BoundarySegment>& segments) {
  std::vector<double> found;
  double top = 0.0;
  for (const BoundarySegment& segment : segments) top = std::max(top, greatest(segment.damping));
  std::vector<BoundarySegment> all = segments;
  for (const BoundarySegment& each : straight_segments(top)) all.push_back(each);
  const BoundaryCrossings crossings = boundary_crossings(curve, all);
  proven = proven && crossings.complete;
  for (const WallPoint& wall : crossings.walls) found.push_back(wall.damping);
  for (const BoundaryBranch& branch : branches) {
    for (const BoundaryBranch::Node* end : {&branch.nodes().front(), &branch.nodes().back()}) {
      if (end->wall.stiffness >= 0.0) found.push_back(end->wall.damping);
    }
  }
  // The Nyquist line ends on K = 0, to rounding.
  if (nyquist) found.push_back(*nyquist / curve.velocity_at_nyquist());
  std::erase_if(found, [](double level) { return !(level > 0.0) || !std::isfinite(level); });
  found.push_back(0.0);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end(),
                          [](double below, double above) { return above - below <= same_level * above; }),
              found.end());
  return found;
}

std::vector<RegionCell> RegionStructure::cells_at(double damping) const {
  const CriticalStiffness critical = critical_stiffness_of(
      curve.plant(), stiffness_crossings(curve.plant(), {damping, curve.velocity_filter_hz()}, by_damping_));
  const double period = curve.plant().period;
  const auto edge = [&](double stiffness) -> RegionEdge {
    if (stiffness == 0.0) return {BoundaryKind::no_stiffness, 0};
    const auto crossover = std::find_if(critical.crossovers.begin(), critical.crossovers.end(),
                                        [&](const Crossover& c) { return c.stiffness == stiffness; });
    if (crossover->frequency == 0.0) return {BoundaryKind::drift, 0};
    if (crossover->frequency >= std::numbers::pi / period) return {BoundaryKind::nyquist, 0};
    const double angle = crossover->frequency * period;
    const auto distance = [angle](const BoundaryBranch& branch) {
      return std::max({branch.nodes().front().angle - angle, angle - branch.nodes().back().angle, 0.0});
    };
    const auto nearest = std::min_element(branches.begin(), branches.end(),
                                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (nearest == branches.end() || distance(*nearest) > same_angle * angle) {
      throw Error(ErrorCode::did_not_converge, "a crossover is not on the stability boundary that was followed");
    }
    return {BoundaryKind::oscillation, static_cast<std::size_t>(nearest - branches.begin())};
  };
  std::vector<RegionCell> cells;
  for (const StableInterval& interval : critical.stable_intervals) {
    RegionCell cell{edge(interval.lower), std::nullopt};
    if (interval.upper) cell.right = edge(*interval.upper);
    cells.push_back(cell);
  }
  return cells;
}

RegionStructure::EdgePoint RegionStructure::edge_at(const RegionEdge& edge, double damping) const {
  switch (edge.kind) {
    case BoundaryKind::nyquist:
      return {*nyquist - damping * curve.velocity_at_nyquist(), std::numbers::pi};
    case BoundaryKind::drift:
      return {*drift, 0.0};
    case BoundaryKind::oscillation: {
      const BoundaryBranch::Node node = branches[edge.branch].at_damping(curve, damping);
      return {node.wall.stiffness, node.angle};
    }
    case BoundaryKind::no_stiffness:
    case BoundaryKind::no_damping:
      break;
  }
  return {0.0, 0.0};
}

// Whether the cells are the stable intervals at this B: between the same pieces of boundary, or to rounding at the same
// K.
bool RegionStructure::agree_at(const std::vector<RegionCell>& cells, double damping) const {
  const std::vector<RegionCell> exact = cells_at(damping);
  const auto agree = [&](const RegionEdge& a, const RegionEdge& b) {
    if (a == b) return true;
    const double here = edge_at(a, damping).stiffness;
    const double there = edge_at(b, damping).stiffness;
    return std::abs(here - there) <= same_stiffness * (std::abs(there) + damping / curve.plant().period);
  };
  return std::equal(cells.begin(), cells.end(), exact.begin(), exact.end(),
                    [&](const RegionCell& a, const RegionCell& b) {
                      return agree(a.left, b.left) && a.right.has_value() == b.right.has_value() &&
                             (!a.right || agree(*a.right, *b.right));
                    });
}

// Near both ends; and where it spans orders of magnitude at several places between.
bool RegionStructure::agree_within(const std::vector<RegionCell>& cells, double lower, double upper) const {
  const double guard = guard_share * (upper - lower);
  if (!agree_at(cells, lower + guard) || !agree_at(cells, upper - guard)) return false;
  const double lowest = std::max(lower, lowest_share * upper);
  for (double damping = upper / check_ratio; damping > lowest; damping /= check_ratio) {
    if (!agree_at(cells, damping)) return false;
  }
  return true;
}

// Below the last slab, or as part of it where the cells are the same. Nothing stable above the first one.
void RegionStructure::add_below(double lower, double upper, std::vector<RegionCell> cells) {
  if (slabs.empty() && cells.empty()) return;
  if (!slabs.empty() && slabs.back().cells == cells) {
    slabs.back().lower = lower;
  } else {
    slabs.push_back({lower, upper, std::move(cells)});
  }
}

void RegionStructure::add_slabs(double bottom, double top) {
  struct Range {
    double lower;
    double upper;
  };
  std::vector<Range> ranges{{bottom, top}};  // the highest last
  while (!ranges.empty()) {
    const auto [lower, upper] = ranges.back();
    ranges.pop_back();
    if (divisions_left_-- == 0) {
      throw Error(ErrorCode::did_not_converge,
                  "the stable stiffnesses change too often as the virtual damper varies for their region to be told");
    }
    const double height = upper - lower;
    std::vector<RegionCell> cells = cells_at(lower + 0.5 * height);
    const double unresolved = slabs.empty() ? least_level * top : finest_detail * slabs.front().upper;
    if (height <= least_height * upper || upper <= unresolved || agree_within(cells, lower, upper)) {
      add_below(lower, upper, std::move(cells));
      continue;
    }
    const double division = lower == 0.0          ? upper / first_division
                            : upper > 4.0 * lower ? std::sqrt(lower * upper)
                                                  : lower + 0.5 * height;
    ranges.push_back({lower, division});
    ranges.push_back({division, upper});
  }
}

}  // namespace zwidth::internal
