#include "zwidth/stability/user_family.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr int levels = 5;  // of each range
constexpr std::size_t most_starts = 4;
constexpr double first_step = 0.125;
constexpr double last_step = 1e-5;
constexpr double step_ratio = 0.25;
constexpr int max_moves = 200;            // of one pattern search
constexpr double same_stiffness = 1e-12;  // relative
constexpr double grid_share = 0.3;        // of the progress

/// A user of the family: 0..1 from least to greatest of each range.
using Place = std::array<double, 3>;

struct Found {
  Place place{};
  double stiffness = 0.0;
};

void check(const ValueRange& range, const char* name) {
  if (range.least >= 0.0 && range.greatest >= range.least && std::isfinite(range.greatest)) return;
  throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::range_not_possible,
                                            .evidence = {{"least", range.least}, {"greatest", range.greatest}},
                                            .subjects = {{"name", name}}});
}

class FamilySearch {
 public:
  FamilySearch(const Device& device, const UserFamily& family, VirtualDamper damper, const Progress& progress)
      : device_(device), ranges_{family.mass, family.damping, family.stiffness}, damper_(damper), progress_(progress) {}

  [[nodiscard]] User user_at(const Place& place) const {
    const auto value = [&](std::size_t i) {
      const ValueRange& range = ranges_[i];
      // Cubed: the ranges often begin at 0, where a small value makes more difference than a large one.
      return place[i] == 1.0 ? range.greatest
                             : range.least + (range.greatest - range.least) * place[i] * place[i] * place[i];
    };
    return {value(0), value(1), value(2)};
  }

  [[nodiscard]] double stiffness_at(const Place& place) const {
    tell(progress_, 0.0);
    DeviceParameters parameters = device_.parameters();
    parameters.uncertainty.reset();  // it may be of the user who is replaced
    parameters.user = user_at(place);
    return critical_stiffness(filtered_plant(Device(std::move(parameters))), damper_).stiffness;
  }

  /// Places 0, 1/4, ..., 1 of each range in all combinations; of an empty range only 0.
  [[nodiscard]] std::vector<Found> grid() const {
    std::array<int, 3> counts{};
    for (std::size_t i = 0; i < 3; ++i) counts[i] = is_varied(i) ? levels : 1;
    std::vector<Found> points;
    points.reserve(static_cast<std::size_t>(counts[0] * counts[1] * counts[2]));
    for (int i = 0; i < counts[0]; ++i) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int k = 0; k < counts[2]; ++k) {
          const Place place{i / (levels - 1.0), j / (levels - 1.0), k / (levels - 1.0)};
          points.push_back({place, stiffness_at(place)});
        }
        tell(progress_, static_cast<double>(points.size()) / static_cast<double>(points.capacity()));
      }
    }
    return points;
  }

  /// Downhill along the axes and the diagonals of the box, in ever smaller steps.
  [[nodiscard]] Found descended(Found best) const {
    int moves = 0;
    for (double step = first_step; step > last_step; step *= step_ratio) {
      while (moves < max_moves) {
        const Found next = best_neighbour(best, step);
        if (!(next.stiffness < best.stiffness)) break;
        best = next;
        ++moves;
      }
    }
    // An end of a range rather than a place that rounding prefers to it.
    for (std::size_t i = 0; i < 3; ++i) {
      if (!is_varied(i)) continue;
      for (const double end : {0.0, 1.0}) {
        Found moved = best;
        moved.place[i] = end;
        if (std::abs(best.place[i] - end) > first_step || moved.place == best.place) continue;
        moved.stiffness = stiffness_at(moved.place);
        if (moved.stiffness <= best.stiffness * (1.0 + same_stiffness)) best = moved;
      }
    }
    return best;
  }

 private:
  [[nodiscard]] bool is_varied(std::size_t i) const { return ranges_[i].greatest > ranges_[i].least; }

  [[nodiscard]] Found best_neighbour(const Found& from, double step) const {
    static constexpr int directions[][3] = {{1, 0, 0},  {-1, 0, 0},  {0, 1, 0},   {0, -1, 0},  {0, 0, 1},
                                            {0, 0, -1}, {1, 1, 1},   {1, 1, -1},  {1, -1, 1},  {1, -1, -1},
                                            {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {-1, -1, -1}};
    Found best = from;
    for (const auto& direction : directions) {
      Place place = from.place;
      for (std::size_t i = 0; i < 3; ++i) {
        if (is_varied(i)) place[i] = std::clamp(place[i] + direction[i] * step, 0.0, 1.0);
      }
      if (place == from.place) continue;
      const double stiffness = stiffness_at(place);
      if (stiffness < best.stiffness) best = {place, stiffness};
    }
    return best;
  }

  const Device& device_;
  std::array<ValueRange, 3> ranges_;
  VirtualDamper damper_;
  const Progress& progress_;
};

/// The points of the grid that no neighbour undercuts, the best few of them.
std::vector<Found> starts(const std::vector<Found>& grid) {
  constexpr double neighbour = 1.5 / (levels - 1.0);
  std::vector<Found> lowest;
  for (const Found& point : grid) {
    const bool is_undercut = std::any_of(grid.begin(), grid.end(), [&](const Found& other) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(other.place[i] - point.place[i]) > neighbour) return false;
      }
      return other.stiffness < point.stiffness;
    });
    if (!is_undercut && std::isfinite(point.stiffness)) lowest.push_back(point);
  }
  std::stable_sort(lowest.begin(), lowest.end(),
                   [](const Found& a, const Found& b) { return a.stiffness < b.stiffness; });
  if (lowest.size() > most_starts) lowest.resize(most_starts);
  return lowest;
}

}  // namespace

UserFamily user_family(const UserRanges& ranges, const User& own) {
  const auto or_own = [](const std::optional<ValueRange>& range, double value) {
    return range.value_or(ValueRange{value, value});
  };
  return {or_own(ranges.mass, own.mass), or_own(ranges.damping, own.damping), or_own(ranges.stiffness, own.stiffness)};
}

WorstOfFamily worst_of_family(const Device& device, const UserFamily& family, VirtualDamper damper,
                              const Progress& progress) {
  if (!device.has_bodies()) throw Error(ErrorCode::needs_bodies, {.code = ProblemCode::no_body_for_user});
  check(family.mass, "mass");
  check(family.damping, "damping");
  check(family.stiffness, "stiffness");
  StagedProgress stages(progress);
  stages.next(grid_share);
  const FamilySearch search(device, family, damper, stages.stage());
  const std::vector<Found> grid = search.grid();
  Found worst = grid.front();
  const std::vector<Found> from = starts(grid);
  for (std::size_t i = 0; i < from.size(); ++i) {
    stages.next(grid_share + (1.0 - grid_share) * static_cast<double>(i + 1) / static_cast<double>(from.size()));
    const Found found = from[i].stiffness > 0.0 ? search.descended(from[i]) : from[i];
    if (found.stiffness < worst.stiffness) worst = found;
  }
  stages.done();
  return {search.user_at(worst.place), worst.stiffness};
}

}  // namespace zwidth
