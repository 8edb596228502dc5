#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "design/synthesis/damper_limits.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "design/synthesis/worst_case_screening.hpp"
#include "model/known_structure.hpp"
#include "stability/loop/damper_response.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::internal {
namespace {

constexpr int damper_filters = 7;
constexpr double fastest_cutoff = 0.4;   // of the sampling rate
constexpr double slowest_cutoff = 0.01;  // the same
constexpr double worth_a_cutoff = 0.02;  // relative gain of what is felt
constexpr double hand_hz = 10.0;         // the fastest voluntary motion of a hand

struct Damper {
  VirtualDamper damper;
  WallBound bound = WallBound::none;
};

/// No velocity filter, then filters from fast to slow.
std::vector<double> cutoffs(double period) {
  std::vector<double> result{0.0};
  for (int i = 0; i < damper_filters; ++i) {
    result.push_back(fastest_cutoff / period *
                     std::pow(slowest_cutoff / fastest_cutoff, static_cast<double>(i) / (damper_filters - 1)));
  }
  return result;
}

/// The damping of the damper in a motion as fast as a hand's. B alone misleads: behind a slower filter a larger B feels the same.
double felt(VirtualDamper damper, double period) {
  const double frequency = std::min(2.0 * std::numbers::pi * hand_hz, 0.1 * std::numbers::pi / period);
  return damper_response(damper, period, frequency).imag() / frequency;
}

/// The B that all but a share of these devices bear.
double borne(const std::vector<Device>& devices, double velocity_filter_hz, double may_fail,
             const RecommendationOptions& options) {
  std::vector<double> strongest;
  strongest.reserve(devices.size());
  for (const Device& each : devices) {
    strongest.push_back(DamperLimits(each, options).strongest(velocity_filter_hz).damping);
  }
  std::ranges::sort(strongest);
  return strongest[static_cast<std::size_t>(may_fail * static_cast<double>(strongest.size()))];
}

class DamperRecommendation {
 public:
  DamperRecommendation(const Device& device, const RecommendationOptions& options)
      : device_(device), options_(options), limits_(device, options) {}

  [[nodiscard]] WallRecommendation answer() {
    WallRecommendation result;
    remark_on_bounds(result);
    std::optional<Damper> best;
    std::optional<Damper> unfiltered;
    for (const double cutoff : cutoffs(device_.loop().sampling_period)) {
      const DamperLimits::Strongest strongest = limits_.strongest(cutoff);
      if (!std::isfinite(strongest.damping)) {
        result.status = WallRecommendation::Status::unbounded;
        result.reason = Finding{.code = FindingCode::no_damping_too_much};
        return result;
      }
      const Damper found{{strongest.damping, cutoff}, strongest.bound};
      if (cutoff == 0.0) unfiltered = found;
      const double period = device_.loop().sampling_period;
      if (strongest.damping > 0.0 &&
          (!best || felt(found.damper, period) > felt(best->damper, period) * (1.0 + worth_a_cutoff))) {
        best = found;
      }
    }
    if (options_.modal_frequency_uncertainty > 0.0) result.modal_shifts_checked = modal_shifts_held;
    if (best) lower(*best, result);
    if (!best || !(best->damper.damping > 0.0)) {
      if (!result.reason) result.reason = why_no_damper();
      return result;
    }
    RecommendedWall wall = described(Kind::recommended, *best, result.trust);
    if (result.trust.refused()) {
      result.status = WallRecommendation::Status::refused;
      return result;
    }
    if (wall.wall.velocity_filter_hz > 0.0) wall.bounded_by.velocity_filter = best->bound;
    result.status = WallRecommendation::Status::found;
    result.wall = std::move(wall);
    if (best->damper.velocity_filter_hz > 0.0) add(Kind::no_velocity_filter, *unfiltered, result);
    return result;
  }

 private:
  using Kind = RecommendedWall::Kind;

  /// What uncertainty and modal shifts leave of it.
  void lower(Damper& found, WallRecommendation& result) const {
    const auto take = [&](const std::vector<Device>& devices, double may_fail, WallBound by) {
      const double least = borne(devices, found.damper.velocity_filter_hz, may_fail, options_);
      if (least < found.damper.damping) found = {{least, found.damper.velocity_filter_hz}, by};
    };
    const auto& uncertainty = device_.parameters().uncertainty;
    if (uncertainty && !uncertainty->parameters.empty()) {
      take(drawn(device_, options_), draws_that_may_fail, WallBound::uncertainty);
      if (!(found.damper.damping > 0.0)) result.reason = Finding{.code = FindingCode::uncertainty_leaves_no_damper};
    }
    if (options_.modal_frequency_uncertainty > 0.0 && found.damper.damping > 0.0) {
      take(with_modal_shifts(device_, options_.modal_frequency_uncertainty), 0.0,
           WallBound::modal_frequency_uncertainty);
      if (!(found.damper.damping > 0.0)) result.reason = Finding{.code = FindingCode::drift_leaves_no_damper};
    }
  }

  [[nodiscard]] RecommendedWall described(Kind kind, const Damper& found, Trust& trust) const {
    const Device walled = with_wall(device_, 0.0, found.damper);
    RecommendedWall wall;
    wall.kind = kind;
    wall.wall = walled.parameters().wall;
    limits_.check(found.damper, trust);
    if (trust.refused()) return wall;
    if (!limits_.keeps(found.damper)) {
      trust.refuse({.code = FindingCode::wall_margins_contradict, .subjects = {{"what", "damper"}}});
      return wall;
    }
    wall.bounded_by.damping = found.bound;
    wall.margins = wall_margins(walled);
    if (can_be_held(device_)) {
      const AbsoluteStabilityLimit limit = absolute_stability_limit(walled, found.damper, options_.progress);
      if (!limit.trust.refused()) wall.absolute_stability_limit = limit.stiffness;
      wall.absolute_stability_damping_limit = absolute_stability_damping(walled, options_.progress).damping;
    }
    wall.force_per_count = force_per_count(walled);
    return wall;
  }

  void add(Kind kind, Damper found, WallRecommendation& result) const {
    WallRecommendation ignored;
    lower(found, ignored);
    Trust trust;
    if (!(found.damper.damping > 0.0)) return;
    RecommendedWall wall = described(kind, found, trust);
    if (!trust.refused()) result.alternatives.push_back(std::move(wall));
  }

  [[nodiscard]] Finding why_no_damper() const {
    const double nobody = critical_damping(with_wall(device_, 0.0, {})).damping;
    return {.code = nobody > 0.0 ? FindingCode::every_damper_destabilised : FindingCode::no_damper_stable};
  }

  void remark_on_bounds(WallRecommendation& result) const {
    if (options_.quantisation_force && !(device_.parameters().sensor.resolution > 0.0)) {
      result.remarks.push_back(warning({.code = FindingCode::force_per_count_unknown,
                                        .subjects = {{"what", "damper"}},
                                        .key = "sensor.resolution"}));
    }
    if (!can_be_held(device_)) {
      result.remarks.push_back(warning({.code = FindingCode::no_any_user_limit, .subjects = {{"what", "damper"}}}));
    }
  }

  const Device& device_;
  const RecommendationOptions& options_;
  DamperLimits limits_;
};

}  // namespace

WallRecommendation recommend_damper(const Device& device, const RecommendationOptions& options) {
  require_known_structure(device);
  require_one_rate(device);
  return DamperRecommendation(device, options).answer();
}

}  // namespace zwidth::internal
