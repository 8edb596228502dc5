#include "design/region/one_rate_structure.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "design/region/boundary_crossings.hpp"
#include "infinity.hpp"
#include "stability/limit/oscillator_at.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// Of the progress: the curve followed, its crossings found, the slabs told.
constexpr double following_share = 0.4;
constexpr double crossing_share = 0.7;
constexpr double slab_share = 0.9;
// Levels of B closer than this, relative, are one.
constexpr double same_level = 1e-11;
// A slab is checked this share of its height from either end, and by this ratio of B between down to this share of its
// top; it is divided where it does not hold there, down to this height relative to B.
constexpr double guard_share = 1e-3;
constexpr double check_ratio = 8.0;
constexpr double lowest_share = 1e-15;
constexpr double least_height = 1e-9;
// Rounding of an angle as a share of a step of it: a few units of 2^-52.
constexpr double angle_step = 1e-9;
constexpr double rounded_steps = 16.0 * std::numeric_limits<double>::epsilon() / angle_step;
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
constexpr std::uintmax_t most_steps_to_stiffest = 100;

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

OneRateStructure::OneRateStructure(FilteredPlant plant, double velocity_filter_hz, const Progress& progress)
    : curve_(std::move(plant), velocity_filter_hz) {
  if (curve_.plant().terms.empty()) {  // the wall does not see the device
    const RegionCell all{RegionEdge{BoundaryKind::no_stiffness, 0}, std::nullopt};
    slabs.push_back({0.0, infinity, {all}});
    return;
  }
  StagedProgress stages(progress);
  stages.next(following_share);
  nyquist_ = if_positive(curve_.nyquist_stiffness());
  drift_ = drift_stiffness(curve_);
  by_damping_ = damping_crossings(curve_.plant(), {0.0, curve_.velocity_filter_hz()});
  const auto [segments, all_proven] = curve_segments(curve_, wall_bounds(curve_), stages.stage());
  proven = all_proven;
  branches = boundary_branches(curve_, segments);
  stages.next(crossing_share);
  const std::vector<double> found = levels(segments, stages.stage());
  try {
    stages.next(slab_share);
    find_slabs(found, stages.stage());
    if (!(slabs.empty() && !told_apart_) && are_slabs_confirmed(stages.stage())) {
      stages.done();
      return;
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
  }
  by_branches_ = false;
  divisions_left_ = max_divisions;
  stages.next(1.0);
  find_slabs(found, stages.stage());
  // Nothing stable, where pieces of boundary lie on one another to rounding, is no answer.
  if (slabs.empty() && !told_apart_) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::boundary_pieces_coincide});
  }
  stages.done();
}

void OneRateStructure::find_slabs(const std::vector<double>& found, const Progress& progress) {
  slabs.clear();
  for (std::size_t i = found.size() - 1; i > 0; --i) {
    // Where everything meets at K = B = 0 rounding moves levels: what is below is not resolved.
    const double unresolved = slabs.empty() ? 0.0 : finest_detail * slabs.front().upper;
    add_slabs(found[i] > unresolved ? found[i - 1] : 0.0, found[i], progress);
    tell(progress, 1.0 - static_cast<double>(i) / static_cast<double>(found.size()));
    if (found[i] <= unresolved) break;
  }
  std::reverse(slabs.begin(), slabs.end());
}

bool OneRateStructure::are_slabs_confirmed(const Progress& progress) const {
  return std::all_of(slabs.begin(), slabs.end(), [&](const RegionSlab& slab) {
    tell(progress, 1.0);
    const double middle = slab.lower + 0.5 * (slab.upper - slab.lower);
    return agree(slab.cells, cells_by_isolation(middle), middle);
  });
}

std::vector<BoundarySegment> OneRateStructure::straight_segments(double top) const {
  std::vector<BoundarySegment> lines;
  if (nyquist_) {
    const double velocity = curve_.velocity_at_nyquist();
    top = std::max(top, *nyquist_ / velocity);
    add_line(lines, *nyquist_, -velocity, *nyquist_ / velocity);
  }
  add_line(lines, 0.0, 0.0, top);
  if (drift_) add_line(lines, *drift_, 0.0, top);
  return lines;
}

// Every B at which the stable intervals of K may change, from 0.
std::vector<double> OneRateStructure::levels(const std::vector<BoundarySegment>& segments, const Progress& progress) {
  std::vector<double> found;
  double top = 0.0;
  for (const BoundarySegment& segment : segments) top = std::max(top, greatest(segment.damping));
  std::vector<BoundarySegment> all = segments;
  for (const BoundarySegment& each : straight_segments(top)) all.push_back(each);
  const BoundaryCrossings crossings = boundary_crossings(curve_, all, progress);
  proven = proven && crossings.complete;
  told_apart_ = crossings.complete;
  for (const WallPoint& wall : crossings.walls) found.push_back(wall.damping);
  for (const BoundaryBranch& branch : branches) {
    for (const BoundaryBranch::Node* end : {&branch.nodes().front(), &branch.nodes().back()}) {
      if (end->wall.stiffness >= 0.0) found.push_back(end->wall.damping);
    }
  }
  for (const GainCrossing& crossing : by_damping_.crossings) found.push_back(crossing.gain);
  // The Nyquist line ends on K = 0, to rounding.
  if (nyquist_) found.push_back(*nyquist_ / curve_.velocity_at_nyquist());
  std::erase_if(found, [](double level) { return !(level > 0.0) || !std::isfinite(level); });
  found.push_back(0.0);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end(),
                          [](double below, double above) { return above - below <= same_level * above; }),
              found.end());
  return found;
}

std::vector<RegionCell> OneRateStructure::cells_at(double damping) const {
  return by_branches_ ? cells_by_branches(damping) : cells_by_isolation(damping);
}

// The branches at this B > 0 are all the crossovers of K: f of GainLocus is B less that of the curve, times a positive
// number, so that a pole pair leaves with rising K where B rises with the angle.
std::vector<RegionCell> OneRateStructure::cells_by_branches(double damping) const {
  struct Crossing {
    double stiffness;
    int poles_leaving;
    RegionEdge edge;
  };
  const GainLocus locus(curve_.plant(), GainLocus::Gain::stiffness, 0.0, {damping, curve_.velocity_filter_hz()});
  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const double first = branches[i].nodes().front().wall.damping;
    const double last = branches[i].nodes().back().wall.damping;
    if ((first > damping) == (last > damping)) continue;
    const RegionEdge edge{BoundaryKind::oscillation, i};
    crossings.push_back({edge_at(edge, damping).stiffness, last > first ? 2 : -2, edge});
  }
  if (drift_) crossings.push_back({*drift_, locus.value(0.0) < 0.0 ? 1 : -1, {BoundaryKind::drift, 0}});
  if (nyquist_) {
    const RegionEdge edge{BoundaryKind::nyquist, 0};
    crossings.push_back({edge_at(edge, damping).stiffness, locus.value(std::numbers::pi) > 0.0 ? 1 : -1, edge});
  }
  std::erase_if(crossings, [](const Crossing& each) { return !(each.stiffness > 0.0); });
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.stiffness < b.stiffness; });
  int unstable = locus.initially_unstable(locus.value(0.0)) + unstable_poles(by_damping_, damping);
  for (const SampledTerm& term : curve_.plant().terms) unstable -= term.unstable_poles;
  std::vector<RegionCell> cells;
  RegionEdge left{BoundaryKind::no_stiffness, 0};
  for (const Crossing& each : crossings) {
    if (unstable == 0) cells.push_back({left, each.edge});
    unstable += each.poles_leaving;
    left = each.edge;
  }
  if (unstable == 0) cells.push_back({left, std::nullopt});
  return cells;
}

std::vector<RegionCell> OneRateStructure::cells_by_isolation(double damping) const {
  const CriticalStiffness critical = critical_stiffness_of(
      curve_.plant(), stiffness_crossings(curve_.plant(), {damping, curve_.velocity_filter_hz()}, by_damping_));
  const double period = curve_.plant().period;
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
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::crossover_off_boundary});
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

OneRateStructure::EdgePoint OneRateStructure::edge_at(const RegionEdge& edge, double damping) const {
  switch (edge.kind) {
    case BoundaryKind::nyquist:
      return {*nyquist_ - damping * curve_.velocity_at_nyquist(), std::numbers::pi};
    case BoundaryKind::drift:
      return {*drift_, 0.0};
    case BoundaryKind::oscillation: {
      const BoundaryBranch::Node node = branches[edge.branch].at_damping(curve_, damping);
      return {node.wall.stiffness, node.angle};
    }
    case BoundaryKind::no_stiffness:
    case BoundaryKind::no_damping:
      break;
  }
  return {0.0, 0.0};
}

bool OneRateStructure::is_curved(const RegionEdge& edge) const { return edge.kind == BoundaryKind::oscillation; }

RegionStructure::Node OneRateStructure::between(const Node& from, const Node& to, double part) const {
  const double angle = from.angle + part * (to.angle - from.angle);
  return {angle, curve_.at(angle)};
}

std::vector<RegionStructure::Node> OneRateStructure::nodes_between(std::size_t branch, const Node& first,
                                                                   const Node& last) const {
  std::vector<Node> nodes = branches[branch].nodes();
  std::erase_if(nodes,
                [&](const Node& each) { return !((each.angle - first.angle) * (each.angle - last.angle) < 0.0); });
  if (last.angle < first.angle) std::ranges::reverse(nodes);
  return nodes;
}

BoundaryPoint OneRateStructure::stiffest_between(const BoundaryPoint& first, const BoundaryPoint& last) const {
  std::uintmax_t steps = most_steps_to_stiffest;
  const auto [low, high] = std::minmax({*first.frequency * period(), *last.frequency * period()});
  const double angle = boost::math::tools::brent_find_minima([&](double a) { return -curve_.at(a).stiffness; }, low,
                                                             high, std::numeric_limits<double>::digits / 2, steps)
                           .first;
  const WallPoint wall = curve_.at(angle);
  return {wall.stiffness, wall.damping, angle / period(), oscillator_at(curve_.plant(), angle)};
}

BoundaryPoint OneRateStructure::seen_at(const WallPoint& wall, double angle) const {
  const double frequency = angle >= std::numbers::pi ? std::numbers::pi / period() : angle / period();
  return {wall.stiffness, wall.damping, frequency, oscillator_at(curve_.plant(), angle)};
}

// Whether these cells are the same at this B: between the same pieces of boundary, or to rounding at the same K.
bool OneRateStructure::agree(const std::vector<RegionCell>& cells, const std::vector<RegionCell>& others,
                             double damping) const {
  const double rounding = rounding_at(damping, stiffest_of(cells, damping)).stiffness;
  const auto meet = [&](const RegionEdge& a, const RegionEdge& b) {
    if (a == b) return true;
    const double here = edge_at(a, damping).stiffness;
    const double there = edge_at(b, damping).stiffness;
    return std::abs(here - there) <= same_stiffness * (std::abs(there) + damping / curve_.plant().period) + rounding;
  };
  return std::equal(cells.begin(), cells.end(), others.begin(), others.end(),
                    [&](const RegionCell& a, const RegionCell& b) {
                      return meet(a.left, b.left) && a.right.has_value() == b.right.has_value() &&
                             (!a.right || meet(*a.right, *b.right));
                    });
}

// Near both ends; and where it spans orders of magnitude at several places between.
bool OneRateStructure::agree_within(const std::vector<RegionCell>& cells, double lower, double upper) const {
  const double guard = guard_share * (upper - lower);
  const auto agree_at = [&](double damping) { return agree(cells, cells_at(damping), damping); };
  if (!agree_at(lower + guard) || !agree_at(upper - guard)) return false;
  const double lowest = std::max(lower, lowest_share * upper);
  for (double damping = upper / check_ratio; damping > lowest; damping /= check_ratio) {
    if (!agree_at(damping)) return false;
  }
  return true;
}

// Beside a pole that is hardly damped the curve runs far within few digits of the angle.
WallPoint OneRateStructure::rounding_at(double damping, double stiffest) const {
  WallPoint greatest;
  for (const BoundaryBranch& branch : branches) {
    const BoundaryBranch::Node node = branch.at_damping(curve_, damping);
    const WallPoint moved = curve_.at(node.angle * (1.0 - angle_step));
    const WallPoint rounding{rounded_steps * std::abs(moved.stiffness - node.wall.stiffness),
                             rounded_steps * std::abs(moved.damping - node.wall.damping)};
    // It does not reach this B, or not near these K.
    if (std::abs(node.wall.damping - damping) > same_stiffness * damping + rounding.damping) continue;
    if (std::abs(node.wall.stiffness) > 2.0 * stiffest + rounding.stiffness) continue;
    greatest.stiffness = std::max(greatest.stiffness, rounding.stiffness);
    greatest.damping = std::max(greatest.damping, rounding.damping);
  }
  return greatest;
}

double OneRateStructure::stiffest_of(const std::vector<RegionCell>& cells, double damping) const {
  if (cells.empty()) return 0.0;
  return cells.back().right ? edge_at(*cells.back().right, damping).stiffness : infinity;
}

// Below the last slab, or as part of it where the cells are the same. Nothing stable above the first one.
void OneRateStructure::add_below(double lower, double upper, std::vector<RegionCell> cells) {
  if (slabs.empty() && cells.empty()) return;
  if (!slabs.empty() && slabs.back().cells == cells) {
    slabs.back().lower = lower;
  } else {
    slabs.push_back({lower, upper, std::move(cells)});
  }
}

void OneRateStructure::add_slabs(double bottom, double top, const Progress& progress) {
  struct Range {
    double lower;
    double upper;
  };
  std::vector<Range> ranges{{bottom, top}};  // the highest last
  while (!ranges.empty()) {
    tell(progress, 0.0);
    const auto [lower, upper] = ranges.back();
    ranges.pop_back();
    const double height = upper - lower;
    const double unresolved = slabs.empty() ? least_level * top : finest_detail * slabs.front().upper;
    std::vector<RegionCell> cells = cells_at(lower + 0.5 * height);
    // Two routes to one level: what lies between is rounding.
    const double rounding = rounding_at(lower + 0.5 * height, stiffest_of(cells, lower + 0.5 * height)).damping;
    if (upper > unresolved && height <= std::max(least_height * upper, rounding)) {
      if (!slabs.empty()) slabs.back().lower = lower;
      continue;
    }
    if (upper <= unresolved || agree_within(cells, lower, upper)) {
      add_below(lower, upper, std::move(cells));
      continue;
    }
    if (divisions_left_-- == 0) {
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::region_changes_too_often});
    }
    const double division = lower == 0.0          ? upper / first_division
                            : upper > 4.0 * lower ? std::sqrt(lower * upper)
                                                  : lower + 0.5 * height;
    ranges.push_back({lower, division});
    ranges.push_back({division, upper});
  }
}

}  // namespace zwidth::internal
