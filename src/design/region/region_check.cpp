#include "design/region/region_check.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <utility>
#include <vector>

#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/second_route/pole_count.hpp"
#include "stability/second_route/routh_count.hpp"
#include "stability/tip/gain_march.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth::internal {
namespace {

// Poles this near the unit circle may be on either side: their rounding, and poles that the wall does not move.
constexpr double on_circle = 1e-9;
// A contradiction must be the same this far away, relative, in K and in B: it is not one about the boundary's last digits.
constexpr double clear_of_boundary = 1e-4;
// Of the outline a wall is clear this many deviations from it.
constexpr double clear_of_outline = 4.0;
constexpr double beyond = 1.15;  // of the extent, the walls asked
constexpr std::size_t most_walls = 160;
constexpr std::size_t least_walls = 6;
constexpr double work = 2e8;  // operations: eigenvalues take some 25 n³ of them
constexpr Eigen::Index largest_order = 400;
constexpr Eigen::Index largest_order_for_routh = 40;
constexpr int ratios = 5;                   // walls by ratios, a decade apart
constexpr std::size_t walls_in_digits = 6;  // where double precision decides on none
// Where no wall is stable there is no extent: loop gains at mid band that are asked instead.
constexpr double loop_gains[] = {1e-6, 1e-4, 1e-2, 1.0};

class ClosedLoop {
 public:
  explicit ClosedLoop(const Device& device) : wall_(device.parameters().wall) {
    if (is_point_wall(device)) {
      tip_ = tip_of_point_wall(device);
      states_ = wall_loop(*tip_, wall_at({1.0, 1.0})).state.rows();
      return;
    }
    plant_ = sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
    if (has_damper_loop(device.loop())) {
      two_rates_.emplace(TwoRateDevice(device, 1.0).as_it_runs(device));
      states_ = static_cast<Eigen::Index>(two_rates_->states());
      return;
    }
    states_ = plant_.Phi.rows() + static_cast<Eigen::Index>(plant_.delay_samples + 3 + 2 * wall_.filters.size());
    if (order() > largest_order_for_routh || !RouthCount::suits(plant_)) return;
    Wall damped = wall_;
    damped.damping = 1.0;  // the loop then has the damper's states
    routh_.emplace(plant_, damped);
  }

  // Of the loop with a damper.
  [[nodiscard]] Eigen::Index order() const { return states_; }
  [[nodiscard]] bool confirms(const WallPoint& at, bool stable) const {
    return (routh_ && routh_->surely(stable, at.stiffness, at.damping)) || side(at) == (stable ? -1 : 1);
  }
  // -1, 1: certainly stable, certainly not; 0: on the circle to rounding.
  [[nodiscard]] int side(const WallPoint& at) const {
    const double excess = excess_of(at);
    return excess < -on_circle ? -1 : excess > on_circle ? 1 : 0;
  }
  // The same side a little further on.
  [[nodiscard]] bool is_clear(const WallPoint& at, int side_here) const {
    for (const double factor : {1.0 - clear_of_boundary, 1.0 + clear_of_boundary}) {
      if (side({factor * at.stiffness, at.damping}) != side_here) return false;
      if (at.damping > 0.0 && side({at.stiffness, factor * at.damping}) != side_here) return false;
    }
    return true;
  }

 private:
  // The largest |z| - 1.
  [[nodiscard]] double excess_of(const WallPoint& at) const {
    if (tip_) return stability_excess(wall_loop(*tip_, wall_at(at)), 1.0);
    if (!two_rates_) return zwidth::stability_excess(plant_, wall_at(at));
    double greatest = -1.0;
    for (const std::complex<double>& pole : two_rates_->poles_minus_one(at.stiffness, at.damping)) {
      greatest = std::max(greatest, (2.0 * pole.real() + std::norm(pole)) / (std::abs(1.0 + pole) + 1.0));
    }
    return greatest;
  }

  [[nodiscard]] Wall wall_at(const WallPoint& at) const {
    Wall wall = wall_;
    wall.stiffness = at.stiffness;
    wall.damping = at.damping;
    return wall;
  }

  DiscreteStateSpace plant_;
  std::optional<SampledTip> tip_;  // of a point wall, in place of the plant
  Wall wall_;
  Eigen::Index states_ = 0;
  std::optional<RouthCount> routh_;
  std::optional<ScheduledLoop> two_rates_;
};

// The outlines in shares of the region's extent.
class Outlines {
 public:
  explicit Outlines(const StableRegion& region)
      : stiffness_(region.stiffest->stiffness), damping_(region.most_damped->damping) {
    for (const StableComponent& component : region.components) {
      rings_.emplace_back();
      for (const BoundaryArc& arc : component.outline.arcs) {
        for (const BoundaryPoint& point : arc.points) rings_.back().push_back(share({point.stiffness, point.damping}));
      }
    }
  }

  [[nodiscard]] bool contains(const WallPoint& wall) const {
    const WallPoint at = share(wall);
    bool inside = false;
    for_each_side([&](const WallPoint& a, const WallPoint& b) {
      if ((a.damping > at.damping) == (b.damping > at.damping)) return;
      const double part = (at.damping - a.damping) / (b.damping - a.damping);
      if (at.stiffness < a.stiffness + part * (b.stiffness - a.stiffness)) inside = !inside;
    });
    return inside;
  }

  [[nodiscard]] double distance(const WallPoint& wall) const {
    const WallPoint at = share(wall);
    double least = std::hypot(at.stiffness, at.damping) + 1.0;
    for_each_side([&](const WallPoint& a, const WallPoint& b) {
      const double x = b.stiffness - a.stiffness;
      const double y = b.damping - a.damping;
      const double px = at.stiffness - a.stiffness;
      const double py = at.damping - a.damping;
      const double squared = x * x + y * y;
      const double part = squared > 0.0 ? std::clamp((px * x + py * y) / squared, 0.0, 1.0) : 0.0;
      least = std::min(least, std::hypot(px - part * x, py - part * y));
    });
    return least;
  }

  // On both sides of the boundary, `apart` away.
  [[nodiscard]] std::vector<WallPoint> beside(const StableRegion& region, std::size_t count, double apart) const {
    struct Side {
      WallPoint a;
      WallPoint b;
    };
    std::vector<Side> sides;
    for (const StableComponent& component : region.components) {
      for (const BoundaryArc& arc : component.outline.arcs) {
        if (arc.kind == BoundaryKind::no_stiffness || arc.kind == BoundaryKind::no_damping) continue;
        for (std::size_t i = 1; i < arc.points.size(); ++i) {
          sides.push_back({share({arc.points[i - 1].stiffness, arc.points[i - 1].damping}),
                           share({arc.points[i].stiffness, arc.points[i].damping})});
        }
      }
    }
    std::vector<WallPoint> walls;
    const std::size_t chosen = std::min(count, sides.size());
    for (std::size_t k = 0; k < chosen; ++k) {
      const auto& [a, b] = sides[k * sides.size() / chosen];
      const double x = b.stiffness - a.stiffness;
      const double y = b.damping - a.damping;
      const double length = std::hypot(x, y);
      if (!(length > 0.0)) continue;
      for (const double side : {-apart, apart}) {
        const double stiffness = 0.5 * (a.stiffness + b.stiffness) - side * y / length;
        const double damping = 0.5 * (a.damping + b.damping) + side * x / length;
        if (stiffness > 0.0 && damping >= 0.0) walls.push_back({stiffness * stiffness_, damping * damping_});
      }
    }
    return walls;
  }

 private:
  [[nodiscard]] WallPoint share(const WallPoint& wall) const {
    return {wall.stiffness / stiffness_, damping_ > 0.0 ? wall.damping / damping_ : 0.0};
  }
  template <typename Function>
  void for_each_side(Function&& function) const {
    for (const auto& ring : rings_) {
      for (std::size_t i = 0; i < ring.size(); ++i) function(ring[i], ring[(i + 1) % ring.size()]);
    }
  }

  double stiffness_;
  double damping_;
  std::vector<std::vector<WallPoint>> rings_;
};

double response_size(const Device& device, double frequency) {
  if (!is_point_wall(device)) return std::abs(response(sampled_plant(device), frequency));
  return TipResponse(tip_of_point_wall(device)).at(frequency * device.loop().sampling_period).norm();
}

// Evenly over the extent, then by ratios towards the axes and B = 0.
std::vector<WallPoint> raster(double stiffness, double damping, std::size_t count) {
  std::vector<WallPoint> walls;
  const auto rows = static_cast<int>(std::sqrt(static_cast<double>(count)));
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < rows; ++j) {
      walls.push_back({beyond * stiffness * (i + 0.37) / rows, beyond * damping * (j + 0.61) / rows});
    }
  }
  for (int i = 0; i < ratios; ++i) {
    for (int j = 0; j <= ratios; ++j) {
      walls.push_back({stiffness * std::pow(10.0, -i), j == ratios ? 0.0 : 0.5 * damping * std::pow(10.0, -j)});
    }
  }
  return walls;
}

bool is_stable(const StableWalls& walls, const WallPoint& wall) {
  const std::vector<StableInterval> intervals = walls.stable_stiffnesses(wall.damping);
  return std::any_of(intervals.begin(), intervals.end(), [&](const StableInterval& interval) {
    return wall.stiffness > interval.lower && (!interval.upper || wall.stiffness < *interval.upper);
  });
}

// Beside modes that hardly anything damps every pole is on the circle to rounding: a few walls with a hundred digits.
void check_in_digits(const Device& device, const StableWalls& walls, const std::vector<WallPoint>& asked,
                     RegionCheck& check, const Progress& progress) {
  const auto poles_outside = [&](const WallPoint& at) {
    DeviceParameters parameters = device.parameters();
    parameters.wall.damping = at.damping;
    return unstable_poles_in_digits(Device(std::move(parameters)), at.stiffness);
  };
  const auto is_clearly = [&](bool stable, const WallPoint& at) {
    for (const double factor : {1.0 - clear_of_boundary, 1.0 + clear_of_boundary}) {
      for (const WallPoint& near :
           {WallPoint{factor * at.stiffness, at.damping}, WallPoint{at.stiffness, factor * at.damping}}) {
        const std::optional<int> outside = poles_outside(near);
        if (!outside || (*outside == 0) != stable) return false;
      }
    }
    return true;
  };
  const std::size_t count = std::min(walls_in_digits, asked.size());
  for (std::size_t i = 0; i < count; ++i) {
    tell(progress, 1.0);
    const WallPoint& wall = asked[i * asked.size() / count];
    const std::optional<int> outside = poles_outside(wall);
    if (!outside) continue;
    if ((*outside == 0) == is_stable(walls, wall)) {
      ++check.confirmed;
    } else if (is_clearly(*outside == 0, wall)) {
      check.contradiction = wall;
      return;
    }
  }
}

}  // namespace

RegionCheck check_region(const Device& device, const StableWalls& walls, const StableRegion& region, double deviation,
                         const Progress& progress) {
  RegionCheck check;
  const ClosedLoop loop(device);
  if (loop.order() > largest_order || !region.bounded) return check;
  const auto cubed = std::pow(static_cast<double>(loop.order()), 3.0);
  const auto count = std::clamp(static_cast<std::size_t>(work / (25.0 * cubed)), least_walls, most_walls);
  std::vector<WallPoint> asked;
  std::optional<Outlines> outlines;
  if (region.stiffest) {
    outlines.emplace(region);
    asked = outlines->beside(region, count / 5, 2.0 * clear_of_outline * deviation);
    const auto others = raster(region.stiffest->stiffness, region.most_damped->damping, count / 3);
    asked.insert(asked.end(), others.begin(), others.end());
  } else {
    const double nyquist = 3.14159 / device.loop().sampling_period;
    const double gain = response_size(device, 0.5 * nyquist);
    if (!(gain > 0.0)) return check;
    for (const double loop_gain : loop_gains) {
      for (const double share : {0.0, 1e-4, 1e-2, 0.3}) {
        asked.push_back({loop_gain / gain, share * loop_gain / (gain * nyquist)});
      }
    }
  }
  if (asked.size() > count) {  // as even a choice as any
    std::vector<WallPoint> fewer;
    for (std::size_t i = 0; i < count; ++i) fewer.push_back(asked[i * asked.size() / count]);
    asked = std::move(fewer);
  }
  for (const WallPoint& wall : asked) {
    const bool stable = is_stable(walls, wall);
    tell(progress, static_cast<double>(check.asked++) / static_cast<double>(asked.size()));
    const bool confirmed = loop.confirms(wall, stable);
    const bool drawn = outlines && outlines->contains(wall);
    const bool misdrawn = drawn != stable && outlines && outlines->distance(wall) > clear_of_outline * deviation;
    if (misdrawn) {
      check.contradiction = wall;
      return check;
    }
    if (confirmed) {
      ++check.confirmed;
      continue;
    }
    const int side = loop.side(wall);
    if (side == (stable ? 1 : -1) && loop.is_clear(wall, side)) {
      check.contradiction = wall;
      return check;
    }
  }
  if (check.confirmed == 0 && !has_damper_loop(device.loop()) && !is_point_wall(device) &&
      loop.order() <= static_cast<Eigen::Index>(PoleCount::most_states_for_digits)) {
    check_in_digits(device, walls, asked, check, progress);
  }
  return check;
}

}  // namespace zwidth::internal
