#include "design/synthesis/two_rate_recommendation.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "design/synthesis/damper_limits.hpp"
#include "design/synthesis/described_wall.hpp"
#include "design/synthesis/drive_damper.hpp"
#include "design/synthesis/notch_search.hpp"
#include "design/synthesis/two_rate_limits.hpp"
#include "design/synthesis/wall_check.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "design/synthesis/wall_search.hpp"
#include "design/synthesis/worst_case_screening.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "stability/wall_judgement.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth::internal {
namespace {

constexpr double worth_a_filter_of_drive = 0.02;
constexpr double fastest_filter_of_drive = 0.2;    // of the damper's rate
constexpr double slowest_filter_of_drive = 0.005;  // of the spring's rate
constexpr double filter_step = 2.5;
constexpr double finest_filter_step = 1.1;
constexpr std::array shares_of_damper{1.0, 0.7, 0.5};
constexpr double softer_step = 0.8;
constexpr int most_softer_steps = 12;

struct TwoRateWall {
  VirtualDamper damper;
  BoundedStiffness stiffest;
};

class TwoRateRecommendation {
 public:
  TwoRateRecommendation(const Device& device, const RecommendationOptions& options)
      : device_(device), options_(options), limits_(device, options) {}

  [[nodiscard]] WallRecommendation answer() {
    WallRecommendation result;
    remark_on(result);
    std::optional<TwoRateWall> best = searched();
    if (best && std::isinf(best->stiffest.stiffness)) {
      result.status = WallRecommendation::Status::unbounded;
      result.reason = Finding{.code = FindingCode::no_stiffness_too_much};
      return result;
    }
    if (options_.modal_frequency_uncertainty > 0.0) result.modal_shifts_checked = modal_shifts_held;
    if (best) lower(*best, result);
    if (best && !(best->stiffest.stiffness > 0.0)) best.reset();
    if (best && limits_.has_users()) {
      result.reason = why_negligible(with_wall(device_, best->stiffest.stiffness, best->damper));
      if (result.reason) best.reset();
    }
    if (!best) {
      if (!result.reason) result.reason = Finding{.code = FindingCode::no_wall_keeps_margins_with_any_filter};
      return result;
    }
    RecommendedWall wall = described(RecommendedWall::Kind::recommended, *best, result.trust);
    if (result.trust.refused()) {
      result.status = WallRecommendation::Status::refused;
      return result;
    }
    result.status = WallRecommendation::Status::found;
    result.wall = std::move(wall);
    if (options_.alternatives) add_alternatives(*best, result);
    return result;
  }

 private:
  using Kind = RecommendedWall::Kind;

  [[nodiscard]] double value_of(const TwoRateWall& wall) const {
    return WallSearch::value_of(options_.goal, wall.stiffest.stiffness, wall.damper.damping);
  }

  /// The best B behind this velocity filter, as far as the search looks.
  [[nodiscard]] TwoRateWall best_behind(double cutoff) const {
    const BestDamping found = best_damping(
        with_wall(device_, 0.0, {0.0, cutoff}),
        [&](double damping) {
          const VirtualDamper damper{damping, cutoff};
          return WallSearch::value_of(options_.goal, limits_.stiffest(damper).stiffness, damping);
        },
        options_.progress);
    const VirtualDamper damper{found.damping, found.damping > 0.0 ? cutoff : 0.0};
    return {damper, limits_.stiffest(damper)};
  }

  /// The best of no velocity filter and filters from the damper's rate down to far below the spring's; computed exactly.
  [[nodiscard]] std::optional<TwoRateWall> searched() {
    limits_.search(true);
    TwoRateWall best = best_behind(0.0);
    const auto take = [&](double cutoff) {
      const TwoRateWall candidate = best_behind(cutoff);
      if (value_of(candidate) > value_of(best) * (1.0 + worth_a_filter_of_drive)) best = candidate;
    };
    if (std::isfinite(value_of(best))) {
      const double fastest = fastest_filter_of_drive / damper_timing(device_.loop()).sampling_period;
      const double slowest = slowest_filter_of_drive / device_.loop().sampling_period;
      for (double cutoff = fastest; cutoff >= slowest; cutoff /= filter_step) take(cutoff);
      if (best.damper.velocity_filter_hz > 0.0) {
        for (double step = std::sqrt(filter_step); step > finest_filter_step; step = std::sqrt(step)) {
          const double middle = best.damper.velocity_filter_hz;
          take(middle * step);
          take(middle / step);
        }
      }
    }
    limits_.search(false);
    best.stiffest = limits_.stiffest(best.damper);
    return value_of(best) > 0.0 ? std::optional(best) : std::nullopt;
  }

  /// What uncertainty and modal shifts leave of it.
  void lower(TwoRateWall& wall, WallRecommendation& result) const {
    const auto take = [&](const std::vector<Device>& devices, double may_fail, WallBound by, FindingCode why_none) {
      wall = borne(wall, devices, may_fail, by);
      if (wall.stiffest.stiffness > 0.0) return;
      result.reason = Finding{.code = why_none, .evidence = {{"threshold", may_fail}}};
    };
    const auto& uncertainty = device_.parameters().uncertainty;
    if (uncertainty && !uncertainty->parameters.empty()) {
      take(drawn(device_, options_), draws_that_may_fail, WallBound::uncertainty,
           FindingCode::uncertainty_leaves_no_margins);
    }
    if (options_.modal_frequency_uncertainty > 0.0 && wall.stiffest.stiffness > 0.0) {
      take(with_modal_shifts(device_, options_.modal_frequency_uncertainty), 0.0,
           WallBound::modal_frequency_uncertainty, FindingCode::drift_leaves_no_wall);
    }
  }

  /// The best wall, no stiffer and no more damped, that the device as it is and all but a share of these devices bear; without
  /// stiffness where there is none. Users are those of TwoRateUsers::limit_on_grid().
  [[nodiscard]] TwoRateWall borne(const TwoRateWall& wall, const std::vector<Device>& devices, double may_fail,
                                  WallBound by) const {
    RecommendationOptions asked = options_;
    asked.progress = {};  // told by one thread at a time
    std::vector<std::unique_ptr<TwoRateLimits>> limits(devices.size());
    const auto each_of_them = [&](const auto& work) {
      tell(options_.progress, 0.0);
      tbb::parallel_for(std::size_t{0}, devices.size(), work);
    };
    each_of_them([&](std::size_t i) {
      if (!knows_all_users(devices[i])) return;
      limits[i] = std::make_unique<TwoRateLimits>(devices[i], asked);
      limits[i]->search(true);
    });
    const auto failing = static_cast<std::size_t>(may_fail * static_cast<double>(devices.size()));
    TwoRateWall best{wall.damper, {0.0, by}};
    for (const double share : shares_of_damper) {
      const VirtualDamper damper{share * wall.damper.damping, wall.damper.velocity_filter_hz};
      std::vector<double> stiffest(devices.size(), 0.0);
      each_of_them([&](std::size_t i) {
        if (limits[i]) stiffest[i] = limits[i]->stiffest(damper, wall.stiffest).stiffness;
      });
      std::ranges::sort(stiffest);
      BoundedStiffness found{stiffest[failing], stiffest[failing] < wall.stiffest.stiffness ? by : wall.stiffest.bound};
      for (int step = 0; step < most_softer_steps && found.stiffness > 0.0; ++step) {
        // Softer at the same margins or less: they must still be kept.
        found = limits_.stiffest(damper, found);
        std::vector<char> keeps(devices.size(), 0);
        each_of_them([&](std::size_t i) { keeps[i] = limits[i] && limits[i]->keeps(found.stiffness, damper) ? 1 : 0; });
        if (std::ranges::count(keeps, 0) <= static_cast<std::ptrdiff_t>(failing)) break;
        found = {step + 1 < most_softer_steps ? softer_step * found.stiffness : 0.0, by};
      }
      const TwoRateWall candidate{damper, found};
      if (found.stiffness > 0.0 && value_of(candidate) > value_of(best)) best = candidate;
      if (wall.damper.damping == 0.0) break;
    }
    return best;
  }

  /// With everything that stands behind it; `trust` says what the check found.
  [[nodiscard]] RecommendedWall described(Kind kind, const TwoRateWall& found, Trust& trust) const {
    const Device walled = with_wall(device_, found.stiffest.stiffness, found.damper);
    trust.inherit(critical_stiffness(walled).trust);
    return described_wall(kind, walled, found.stiffest.bound, limits_, options_, trust);
  }

  void add(Kind kind, VirtualDamper damper, WallRecommendation& result) const {
    TwoRateWall found{damper, limits_.stiffest(damper)};
    if (!(found.stiffest.stiffness > 0.0) || !std::isfinite(found.stiffest.stiffness)) return;
    WallRecommendation ignored;
    lower(found, ignored);
    if (!(found.stiffest.stiffness > 0.0)) return;
    Trust trust;
    RecommendedWall wall = described(kind, found, trust);
    add_alternative(std::move(wall), trust, result);
  }

  void add_alternatives(const TwoRateWall& best, WallRecommendation& result) const {
    if (best.damper.damping == 0.0) return;
    add(Kind::no_virtual_damper, {}, result);
    for (const auto& [share, kind] : {std::pair{0.5, Kind::half_damping}, {1.5, Kind::more_damping}}) {
      add(kind, {share * best.damper.damping, best.damper.velocity_filter_hz}, result);
    }
  }

  void remark_on(WallRecommendation& result) const {
    remark_on_resolution(device_, options_, result);
    result.remarks.push_back(limits_.has_users()
                                 ? any_user_limit_scanned(device_.loop())
                                 : warning({.code = FindingCode::no_any_user_limit, .subjects = {{"what", "wall"}}}));
    if (options_.notch && !seen_modes(device_).empty()) result.remarks.push_back(left_out_beside_damper_loop("notch"));
  }

  const Device& device_;
  const RecommendationOptions& options_;
  TwoRateLimits limits_;
};

}  // namespace

WallRecommendation recommend_two_rate_wall(const Device& device, const RecommendationOptions& options) {
  return TwoRateRecommendation(device, options).answer();
}

WallRecommendation recommend_two_rate_damper(const Device& device, const RecommendationOptions& options) {
  WallRecommendation result = recommend_damper(with_loop_of_damper(device), options);
  const auto in_both_loops = [&](RecommendedWall& wall) {
    if (!wall.absolute_stability_limit) return;
    const Device walled = with_wall(device, 0.0, {wall.wall.damping, wall.wall.velocity_filter_hz});
    wall.absolute_stability_limit = any_user_limit(walled, options.progress)->lower_bound();
  };
  if (result.wall) in_both_loops(*result.wall);
  std::ranges::for_each(result.alternatives, in_both_loops);
  return result;
}

std::optional<DriveDamper> recommend_drive_damper(const Device& device, const RecommendationOptions& options,
                                                  const RecommendedWall& found) {
  const std::optional<Device> on_drive = with_damper_on_drive(device);
  if (!on_drive) return std::nullopt;
  RecommendationOptions asked = options;
  asked.alternatives = false;
  try {
    const WallRecommendation with = recommend_two_rate_wall(*on_drive, asked);
    if (!with.wall || !(with.wall->wall.damping > 0.0)) return std::nullopt;
    DriveDamper result;
    result.damping = with.wall->wall.damping;
    result.velocity_filter_hz = with.wall->wall.velocity_filter_hz;
    result.stiffness = *with.wall->wall.stiffness;
    result.absolute_stability_limit = with.wall->absolute_stability_limit;
    result.one_rate_damping = found.wall.damping;
    result.one_rate_stiffness = *found.wall.stiffness;
    complete(result, *on_drive);
    return result;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    return std::nullopt;
  }
}

}  // namespace zwidth::internal
