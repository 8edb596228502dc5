#include "design/region/two_rate_structure.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "infinity.hpp"
#include "stability/limit/oscillator_at.hpp"
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
  find_slabs(stages.stage());
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

std::optional<Node> TwoRateStructure::found_between(const Node& a, const Node& b, double damping) const {
  if (a.angle == std::numbers::pi && b.angle == std::numbers::pi) return std::nullopt;
  const double part = (damping - a.wall.damping) / (b.wall.damping - a.wall.damping);
  if (TwoRateCurve::is_straight(a)) return between(a, b, part);
  const Vector3d way = (TwoRateCurve::place(b) - TwoRateCurve::place(a)).cwiseQuotient(curve_.scales);
  const Vector3d at = TwoRateCurve::place(a) + part * (TwoRateCurve::place(b) - TwoRateCurve::place(a));
  const auto found = curve_.solve({at(0), {at(1), damping}}, Vector3d::UnitZ());
  if (!found) return std::nullopt;
  const Vector3d moved = (TwoRateCurve::place(*found) - TwoRateCurve::place(a)).cwiseQuotient(curve_.scales);
  const double along = moved.dot(way) / way.squaredNorm();
  const double off = (moved - along * way).norm();
  if (!(along > -beside_chord && along < 1.0 + beside_chord && off < way.norm())) return std::nullopt;
  return Node{found->angle, {found->wall.stiffness, damping}};
}

// The damper inside: one slice tells all K; else one at each.
BranchStructure::StableAt TwoRateStructure::stable_at(double damping) const {
  if (curve_.is_damper_inside()) {
    return [slice = region_slice(curve_, damping)](double stiffness) { return slice.is_stable(stiffness); };
  }
  return [this, damping](double stiffness) { return region_slice(curve_, stiffness).is_stable(damping); };
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

Node TwoRateStructure::node_of(const BoundaryPoint& point) const {
  const double turned = std::fmod(*point.frequency * period(), full_turn);
  return {std::min(turned, full_turn - turned), {point.stiffness, point.damping}};
}

BoundaryPoint TwoRateStructure::seen_at(const WallPoint& wall, double angle) const {
  const double frequency = angle > 0.0 ? curve_.frequency({angle, wall}) : 0.0;
  return {wall.stiffness, wall.damping, frequency,
          oscillator_at(curve_.modes(), std::min(frequency * curve_.spring_period(), std::numbers::pi))};
}

}  // namespace zwidth::internal
