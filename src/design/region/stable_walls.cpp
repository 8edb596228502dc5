#include "zwidth/design/stable_walls.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "design/region/one_rate_structure.hpp"
#include "design/region/point_structure.hpp"
#include "design/region/two_rate_structure.hpp"
#include "require_argument.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth {
using namespace internal;
namespace {

FilteredPlant checked(FilteredPlant plant, double velocity_filter_hz) {
  require_not_negative({"velocity filter", velocity_filter_hz, "Hz"});
  return plant;
}

}  // namespace

StableWalls::StableWalls(FilteredPlant plant, double velocity_filter_hz, const Progress& progress)
    : structure_(std::make_shared<const OneRateStructure>(checked(std::move(plant), velocity_filter_hz),
                                                          velocity_filter_hz, progress)) {}

StableWalls::StableWalls(const Device& device, const Progress& progress) {
  if (is_point_wall(device)) {
    structure_ = std::make_shared<const PointStructure>(device, progress);
  } else if (has_damper_loop(device.loop())) {
    structure_ = std::make_shared<const TwoRateStructure>(device, progress);
  } else {
    structure_ = std::make_shared<const OneRateStructure>(filtered_plant(device),
                                                          device.parameters().wall.velocity_filter_hz, progress);
  }
}

double StableWalls::velocity_filter_hz() const { return structure_->velocity_filter_hz(); }

std::vector<StableInterval> StableWalls::stable_stiffnesses(double damping) const {
  require_argument(damping >= 0.0, ProblemCode::negative, {"virtual damper", damping});
  const auto& slabs = structure_->slabs;
  const auto slab = std::partition_point(slabs.begin(), slabs.end(),
                                         [damping](const RegionSlab& each) { return each.upper <= damping; });
  std::vector<StableInterval> intervals;
  if (slab == slabs.end()) return intervals;
  for (const RegionCell& cell : slab->cells) {
    StableInterval interval{structure_->edge_at(cell.left, damping).stiffness, std::nullopt};
    if (cell.right) interval.upper = structure_->edge_at(*cell.right, damping).stiffness;
    if (!interval.upper || interval.lower < *interval.upper) intervals.push_back(interval);
  }
  return intervals;
}

std::vector<std::uint8_t> stable_on_grid(const StableWalls& walls, std::span<const double> stiffnesses,
                                         std::span<const double> dampings) {
  if (!std::is_sorted(stiffnesses.begin(), stiffnesses.end()) ||
      std::any_of(stiffnesses.begin(), stiffnesses.end(), [](double value) { return std::isnan(value); })) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::grid_not_rising});
  }
  std::vector<std::uint8_t> stable(stiffnesses.size() * dampings.size(), 0);
  auto row = stable.begin();
  for (const double damping : dampings) {
    for (const StableInterval& interval : walls.stable_stiffnesses(damping)) {
      const auto first = std::upper_bound(stiffnesses.begin(), stiffnesses.end(), interval.lower);
      const auto last =
          interval.upper ? std::lower_bound(first, stiffnesses.end(), *interval.upper) : stiffnesses.end();
      std::fill(row + (first - stiffnesses.begin()), row + (last - stiffnesses.begin()), std::uint8_t{1});
    }
    row += static_cast<std::ptrdiff_t>(stiffnesses.size());
  }
  return stable;
}

}  // namespace zwidth
