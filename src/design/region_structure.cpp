#include "design/region_structure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "design/strand_crossings.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Levels of B closer than this, relative, are one.
constexpr double same_level = 1e-11;
// A slab is checked this share of its height from either end, and divided where it does not hold there, down to this
// height relative to B.
constexpr double guard_share = 1e-3;
constexpr double least_height = 1e-9;
// Two routes to one K agree to this share of |K| + |B|/T.
constexpr double same_stiffness = 1e-6;
// An angle this far, relative, outside a branch is on its end.
constexpr double same_angle = 1e-6;

Strand line(const WallPoint& from, const WallPoint& to) {
  const auto jet = [](double a, double b) { return BoundaryCurve::Jet{0.5 * (a + b), 0.5 * (b - a), 0.0, 0.0}; };
  return {jet(from.stiffness, to.stiffness), jet(from.damping, to.damping), 0.0, 1.0, true};
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
  const std::vector<Strand> strands = curve_strands(curve, wall_bounds(curve));
  branches = boundary_branches(curve, strands);
  const std::vector<double> found = levels(strands);
  for (std::size_t i = 0; i + 1 < found.size(); ++i) add_slab(found[i], found[i + 1]);
  while (!slabs.empty() && slabs.back().cells.empty()) slabs.pop_back();
}

std::vector<Strand> RegionStructure::straight_strands(double top) const {
  std::vector<Strand> lines;
  if (nyquist) lines.push_back(line({*nyquist, 0.0}, {0.0, *nyquist / curve.velocity_at_nyquist()}));
  for (const Strand& each : lines) top = std::max(top, greatest(each.damping));
  lines.push_back(line({0.0, 0.0}, {0.0, top}));
  if (drift) lines.push_back(line({*drift, 0.0}, {*drift, top}));
  return lines;
}

// Every B at which the stable intervals of K may change, from 0.
std::vector<double> RegionStructure::levels(const std::vector<Strand>& strands) const {
  std::vector<double> found;
  double top = 0.0;
  for (const Strand& strand : strands) top = std::max(top, greatest(strand.damping));
  std::vector<Strand> all = strands;
  for (const Strand& each : straight_strands(top)) all.push_back(each);
  for (const WallPoint& wall : strand_crossings(curve, all)) found.push_back(wall.damping);
  for (const BoundaryBranch& branch : branches) {
    for (const BoundaryBranch::Node* end : {&branch.nodes().front(), &branch.nodes().back()}) {
      if (end->wall.stiffness >= 0.0) found.push_back(end->wall.damping);
    }
  }
  std::erase_if(found, [](double level) { return !(level > 0.0) || !std::isfinite(level); });
  found.push_back(0.0);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end(),
                          [](double below, double above) { return above - below <= same_level * above; }),
              found.end());
  return found;
}

std::vector<RegionCell> RegionStructure::cells_at(double damping) const {
  const CriticalStiffness critical = critical_stiffness(curve.plant(), {damping, curve.velocity_filter_hz()});
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

// Whether the cells are the stable intervals at this B.
bool RegionStructure::hold_at(const std::vector<RegionCell>& cells, double damping) const {
  const auto exact = critical_stiffness(curve.plant(), {damping, curve.velocity_filter_hz()}).stable_intervals;
  const auto agrees = [&](const RegionEdge& edge, double stiffness) {
    const double found = edge_at(edge, damping).stiffness;
    return std::abs(found - stiffness) <= same_stiffness * (stiffness + damping / curve.plant().period);
  };
  return std::equal(cells.begin(), cells.end(), exact.begin(), exact.end(),
                    [&](const RegionCell& cell, const StableInterval& interval) {
                      return agrees(cell.left, interval.lower) &&
                             cell.right.has_value() == interval.upper.has_value() &&
                             (!cell.right || agrees(*cell.right, *interval.upper));
                    });
}

void RegionStructure::add_slab(double lower, double upper) {
  const double height = upper - lower;
  const double middle = lower + 0.5 * height;
  std::vector<RegionCell> cells = cells_at(middle);
  const double guard = guard_share * height;
  if (height > least_height * upper && !(hold_at(cells, lower + guard) && hold_at(cells, upper - guard))) {
    add_slab(lower, middle);
    add_slab(middle, upper);
    return;
  }
  slabs.push_back({lower, upper, std::move(cells)});
}

}  // namespace zwidth::internal
