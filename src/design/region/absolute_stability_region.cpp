#include "zwidth/design/absolute_stability_region.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "design/region/region_structure.hpp"
#include "infinity.hpp"
#include "model/known_structure.hpp"
#include "require_argument.hpp"
#include "stability/users/any_user_limits.hpp"
#include "staged_progress.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double first_ratio = 1e-6;  // the least B > 0 sampled, as a share of the largest
constexpr double scan_ratio = 1.5;
constexpr double scan_share = 0.25;  // of the progress
constexpr int end_bisections = 24;
constexpr int max_depth = 7;
constexpr double rounding = 1e-6;  // relative, of limits

class Sampler {
 public:
  Sampler(const Device& device, const StableWalls& walls, double deviation, const Progress& progress)
      : limits_(device, progress), walls_(walls), deviation_(deviation), progress_(progress) {}

  [[nodiscard]] AbsoluteStabilityPoint at(double damping) {
    tell(progress_, 0.0);
    const AbsoluteStabilityLimit limit = limits_.limit({damping, walls_.velocity_filter_hz()}, progress_);
    if (std::isnan(limit.stiffness)) {
      not_known_.inherit(limit.trust);
      return {damping, 0.0, 0.0};
    }
    const double taken_off = limit.stiffness > 0.0 ? limit.stiffness / (1.0 - limit.truncation) - limit.stiffness : 0.0;
    if (!limit.trust.sound() && taken_off > most_taken_off_) {
      most_taken_off_ = taken_off;
      trust_ = limit.trust;
    }
    // Nobody is a user too. At the end of the region a pole lies on the circle whatever K: no limit at that very B is sure.
    const double nobody = limit_of_nobody(damping);
    if (limit.stiffness <= nobody * (1.0 + rounding)) return {damping, limit.stiffness, limit.frequency};
    if (nobody > 0.0 && limit.stiffness - nobody > most_taken_off_) {
      most_taken_off_ = limit.stiffness - nobody;
      trust_ = {};
      trust_.doubt({.code = FindingCode::any_user_limit_above_nobody,
                    .evidence = {{"damping", damping}, {"any_user_limit", limit.stiffness}, {"nobody_limit", nobody}},
                    .effect = {{"critical_stiffness", nobody}}});
    }
    return {damping, nobody, nobody > 0.0 ? limit.frequency : 0.0};
  }

  // Sound where what is taken off lies within the deviation; a limit that is taken off altogether lies outside.
  [[nodiscard]] Trust trust() const {
    if (not_known_.refused()) return not_known_;
    return most_taken_off_ > deviation_ * stiffness_extent ? trust_ : Trust{};
  }

  // The end of the limit between a B where it is above 0 and one where it is 0.
  [[nodiscard]] AbsoluteStabilityPoint end_between(const AbsoluteStabilityPoint& inside,
                                                   const AbsoluteStabilityPoint& outside) {
    double in = inside.damping;
    double out = outside.damping;
    for (int i = 0; i < end_bisections; ++i) {
      const double middle = 0.5 * (in + out);
      if (middle == in || middle == out) break;
      (at(middle).stiffness > 0.0 ? in : out) = middle;
    }
    return {in, 0.0, 0.0};
  }

  // Appends the points after `from` up to `to`.
  void refine(const AbsoluteStabilityPoint& from, const AbsoluteStabilityPoint& to, int depth,
              std::vector<AbsoluteStabilityPoint>& points) {
    const AbsoluteStabilityPoint middle = at(0.5 * (from.damping + to.damping));
    const double off = std::abs(middle.stiffness - 0.5 * (from.stiffness + to.stiffness)) / stiffness_extent;
    const double width = (to.damping - from.damping) / damping_extent;
    if (depth < max_depth && width > deviation_ && off > deviation_) {
      refine(from, middle, depth + 1, points);
      refine(middle, to, depth + 1, points);
      return;
    }
    tell(progress_, to.damping / largest);
    points.push_back(to);
  }

  // The B, rising, between which a range may be narrow: where a damper alone, or a weak spring beside it, gains or loses
  // stability, with some user or with nobody.
  [[nodiscard]] std::vector<double> ends() const {
    std::vector<double> ends = limits_.ends_of_damper(walls_.velocity_filter_hz());
    if (ends.empty()) return ends;
    for (const RegionSlab& slab : walls_.structure().slabs) ends.push_back(slab.lower);
    std::ranges::sort(ends);
    return ends;
  }

  double stiffness_extent = 0.0;
  double damping_extent = 0.0;
  double largest = infinity;  // B of all ranges

 private:
  [[nodiscard]] double limit_of_nobody(double damping) const {
    const std::vector<StableInterval> intervals = walls_.stable_stiffnesses(damping);
    return intervals.empty() || intervals.front().lower > 0.0 ? 0.0 : intervals.front().upper.value_or(infinity);
  }

  AnyUserLimits limits_;
  const StableWalls& walls_;
  double deviation_;
  const Progress& progress_;
  double most_taken_off_ = 0.0;  // of a limit, N/m
  Trust trust_;                  // of that limit
  Trust not_known_;              // refused with the first limit that is not known
};

std::vector<AbsoluteStabilityPoint> scan(Sampler& sampler, double largest) {
  std::vector<double> dampings{0.0};
  for (double damping = first_ratio * largest; damping < largest; damping *= scan_ratio) dampings.push_back(damping);
  const std::vector<double> ends = sampler.ends();
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double between = 0.5 * (ends[i - 1] + ends[i]);
    if (between > ends[i - 1] && between < largest) dampings.push_back(between);
  }
  dampings.push_back(largest);
  std::ranges::sort(dampings);
  std::vector<AbsoluteStabilityPoint> points;
  points.reserve(dampings.size());
  for (const double each : dampings) points.push_back(sampler.at(each));
  return points;
}

// The scan cut into ranges of B with a limit above 0, their ends found.
std::vector<std::vector<AbsoluteStabilityPoint>> ranges_of(Sampler& sampler,
                                                           const std::vector<AbsoluteStabilityPoint>& points) {
  std::vector<std::vector<AbsoluteStabilityPoint>> ranges;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool here = points[i].stiffness > 0.0;
    const bool before = i > 0 && points[i - 1].stiffness > 0.0;
    if (here && !before) {
      ranges.emplace_back();
      if (i > 0) ranges.back().push_back(sampler.end_between(points[i], points[i - 1]));
    }
    if (here) ranges.back().push_back(points[i]);
    if (!here && before) ranges.back().push_back(sampler.end_between(points[i - 1], points[i]));
  }
  return ranges;
}

}  // namespace

AbsoluteStabilityRegion absolute_stability_region(const Device& device, const StableWalls& walls,
                                                  double largest_damping,
                                                  const AbsoluteStabilityRegionOptions& options) {
  require_known_structure(device);
  require_positive({"largest damping", largest_damping});
  require_fraction({"deviation", options.deviation});
  StagedProgress stages(options.progress);
  stages.next(scan_share);
  Sampler sampler(device, walls, options.deviation, stages.stage());
  AbsoluteStabilityRegion region;
  const auto coarse = ranges_of(sampler, scan(sampler, largest_damping));
  for (const auto& range : coarse) {
    sampler.damping_extent = range.back().damping;
    for (const AbsoluteStabilityPoint& point : range) {
      if (std::isfinite(point.stiffness))
        sampler.stiffness_extent = std::max(sampler.stiffness_extent, point.stiffness);
    }
  }
  stages.next(1.0);
  sampler.largest = coarse.empty() ? largest_damping : coarse.back().back().damping;
  for (const auto& range : coarse) {
    if (sampler.trust().refused()) break;
    std::vector<AbsoluteStabilityPoint> points{range.front()};
    for (std::size_t i = 0; i + 1 < range.size(); ++i) sampler.refine(range[i], range[i + 1], 0, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!region.stiffest || points[i].stiffness > region.stiffest->stiffness) region.stiffest = points[i];
      if (i == 0) continue;
      region.area +=
          0.5 * (points[i].stiffness + points[i - 1].stiffness) * (points[i].damping - points[i - 1].damping);
    }
    region.most_damped = points.back();
    region.ranges.push_back(std::move(points));
  }
  region.is_bound = !knows_all_users(device);
  if (sampler.trust().refused()) region = {};
  region.trust = sampler.trust();
  stages.done();
  return region;
}

}  // namespace zwidth
