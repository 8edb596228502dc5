#include "zwidth/design/wall_recommendation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "design/synthesis/damper_limits.hpp"
#include "design/synthesis/described_wall.hpp"
#include "design/synthesis/notch_search.hpp"
#include "design/synthesis/recommended_wall.hpp"
#include "design/synthesis/two_rate_recommendation.hpp"
#include "design/synthesis/wall_check.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "design/synthesis/wall_lowering.hpp"
#include "design/synthesis/wall_search.hpp"
#include "model/known_structure.hpp"
#include "stability/users/any_grasp.hpp"
#include "stability/users/any_user_limit.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t searched_exactly = 3;  // velocity filters, the most promising, beside none
constexpr double worth_a_damper = 1e-3;      // relative gain of the goal
constexpr double worth_a_filter = 0.02;
constexpr double worth_a_notch = 0.05;
constexpr double more_damping = 1.05;    // where the bound of B is looked for
constexpr double first_damping = 1e-3;   // times K/w, where B is 0
constexpr double faster = 1.25;          // where the bound of the velocity filter is
constexpr double fastest = 0.45;         // of the sampling rate
constexpr double to_be_distinct = 0.01;  // relative, of an alternative

/// One wall on its way: with the filters of its limits closed.
struct Candidate {
  VirtualDamper damper;
  BoundedStiffness stiffest;
  double value = 0.0;
  std::optional<WallFilter> notch;
};

class Recommendation {
 public:
  Recommendation(const Device& device, const RecommendationOptions& options)
      : stages_(options.progress),
        device_(without_wall(device)),
        options_(told(options, stages_)),
        limits_(device_, options_),
        search_(limits_, options_),
        lowering_(device_, options_) {}

  [[nodiscard]] WallRecommendation answer() {
    WallRecommendation result;
    remark_on_bounds(result);
    stages_.next(0.4);
    std::optional<Candidate> best = best_without_notch();
    if (best && std::isinf(best->stiffest.stiffness)) {
      result.status = WallRecommendation::Status::unbounded;
      result.reason = Finding{.code = FindingCode::no_stiffness_too_much};
      return result;
    }
    const std::optional<Candidate> plain = best;
    stages_.next(0.6);
    if (options_.notch) best = with_notch(best);
    stages_.next(0.7);
    if (options_.modal_frequency_uncertainty > 0.0) result.modal_shifts_checked = modal_shifts_held;
    if (best) best = kept(*best, *plain, result);
    if (best && limits_.has_users()) {
      result.reason =
          why_negligible(with_wall(limits_of(best->notch).device(), best->stiffest.stiffness, best->damper));
      if (result.reason) best.reset();
    }
    if (!best) {
      if (!result.reason) result.reason = why_none();
      return result;
    }
    Trust trust;
    stages_.next(0.8);
    RecommendedWall wall = described(Kind::recommended, *best, trust);
    result.trust.inherit(trust);
    if (trust.refused()) {
      result.status = WallRecommendation::Status::refused;
      return result;
    }
    if (options_.alternatives) wall.bounded_by = bounds_of(*best);
    result.status = WallRecommendation::Status::found;
    result.wall = std::move(wall);
    stages_.next(1.0);
    if (options_.alternatives) add_alternatives(*best, plain, result);
    stages_.done();
    return result;
  }

 private:
  using Kind = RecommendedWall::Kind;

  [[nodiscard]] WallLimits& limits_of(const std::optional<WallFilter>& notch) {
    if (notch && !notched_) notched_ = std::make_unique<WallLimits>(with_filter(device_, *notch), options_);
    return notch ? *notched_ : limits_;
  }

  [[nodiscard]] const WallSearch& search_of(const std::optional<WallFilter>& notch) {
    if (!notch) return search_;
    return notched_search_ ? *notched_search_ : notched_search_.emplace(search_, limits_of(notch), *notch);
  }

  [[nodiscard]] Candidate exact(VirtualDamper damper, const std::optional<WallFilter>& notch, WallGoal goal) {
    Candidate candidate{damper, limits_of(notch).stiffest(damper), 0.0, notch};
    candidate.value = WallSearch::value_of(goal, candidate.stiffest.stiffness, damper.damping);
    return candidate;
  }

  /// The best of no velocity filter and the most promising ones, recomputed exactly.
  [[nodiscard]] std::optional<Candidate> best_without_notch() {
    const std::vector<double> cutoffs = search_.velocity_filters();
    for (const double cutoff : cutoffs) {
      found_.push_back(search_.best(cutoff, options_.goal));
      tell(options_.progress, static_cast<double>(found_.size()) / static_cast<double>(cutoffs.size()));
    }
    const auto by_value = [](const auto& a, const auto& b) { return a.value > b.value; };
    std::stable_sort(found_.begin() + 1, found_.end(), by_value);
    std::optional<Candidate> best;
    if (const Candidate spring = exact({}, {}, options_.goal); spring.value > 0.0) best = spring;
    for (std::size_t i = 0; i < std::min(found_.size(), searched_exactly + 1); ++i) {
      const Candidate candidate = exact(found_[i].damper, {}, options_.goal);
      if (i == 0 && candidate.stiffest.stiffness > 0.0) unfiltered_ = candidate;
      if (!(candidate.value > 0.0)) continue;
      const double worth = i == 0 ? worth_a_damper : worth_a_filter;
      if (!best || candidate.value > best->value * (1.0 + worth)) best = candidate;
    }
    if (best && best->damper.velocity_filter_hz > 0.0 && std::isfinite(best->value)) {
      const Candidate near =
          exact(search_.best_near({best->damper, best->value}, options_.goal).damper, {}, options_.goal);
      if (near.value > best->value) best = near;
    }
    return best;
  }

  /// A notch near a mode behind the best damper, B searched again; only where it is worth it and no user minds.
  [[nodiscard]] std::optional<Candidate> with_notch(const std::optional<Candidate>& best) {
    if (!best) return best;
    const std::vector<double> modes = seen_modes(device_);
    if (modes.empty() || device_.parameters().wall.filters.size() >= max_wall_filters) return best;
    const NotchOptions notch_options{
        .goal = limits_.has_users() ? StiffnessGoal::absolute_stability_limit : StiffnessGoal::critical_stiffness,
        .gain_margin = options_.gain_margin,
        .phase_margin = options_.phase_margin,
        .progress = options_.progress};
    NotchSearch search(notch_options, modes, device_.loop().sampling_period, limits_.has_users());
    search.add(with_wall(device_, best->stiffest.stiffness, best->damper), search_.grid());
    for (const double modal_shift : {-options_.modal_frequency_uncertainty, options_.modal_frequency_uncertainty}) {
      if (modal_shift != 0.0)
        search.add(with_wall(with_modal_shift(device_, modal_shift), best->stiffest.stiffness, best->damper));
    }
    std::pair<double, NotchSearch::Point> found{0.0, {}};
    for (const NotchSearch::Point& start : search.candidates(options_.progress)) {
      found = std::max(found, search.refine_on_grid(start));
    }
    if (!(found.first > best->stiffest.stiffness * (1.0 + worth_a_notch))) return best;
    const WallFilter notch = NotchSearch::notch_at(found.second);
    const Candidate candidate =
        exact(search_of(notch).best(best->damper.velocity_filter_hz, options_.goal).damper, notch, options_.goal);
    const bool lower_absolute_stability_limit =
        limits_.has_users() && is_lower(limits_of(notch).limit(candidate.damper), limits_.limit(candidate.damper));
    if (lower_absolute_stability_limit || !(candidate.value > best->value * (1.0 + worth_a_notch))) return best;
    return candidate;
  }

  /// What uncertainty and modal shifts leave of it.
  [[nodiscard]] std::optional<Candidate> lowered(Candidate candidate, WallRecommendation& result) {
    const WallLowering::Kept kept =
        lowering_.lowered(candidate.stiffest.stiffness, candidate.damper, candidate.notch, options_.goal);
    if (!(kept.stiffness > 0.0)) {
      result.reason = kept.why_none;
      return std::nullopt;
    }
    if (!kept.by) return candidate;
    candidate.stiffest = {kept.stiffness, *kept.by};
    candidate.damper = kept.damper;
    candidate.value = WallSearch::value_of(options_.goal, kept.stiffness, kept.damper.damping);
    // Softer at the same margins or less damped: the device as it is must still keep them.
    if (!limits_of(candidate.notch).keeps(kept.stiffness, kept.damper)) {
      result.reason = Finding{.code = FindingCode::lower_end_leaves_no_margins};
      return std::nullopt;
    }
    return candidate;
  }

  /// The same of the best; where the modal frequencies are uncertain a notch must be worth it there too.
  [[nodiscard]] std::optional<Candidate> kept(const Candidate& best, const Candidate& plain,
                                              WallRecommendation& result) {
    std::optional<Candidate> notched = lowered(best, result);
    if (!best.notch || !(options_.modal_frequency_uncertainty > 0.0)) return notched;
    WallRecommendation without;
    std::optional<Candidate> unnotched = lowered(plain, without);
    if (!unnotched || (notched && notched->value > unnotched->value * (1.0 + worth_a_notch))) return notched;
    result.reason.reset();
    return unnotched;
  }

  [[nodiscard]] WallBound bound_with(const Candidate& candidate, VirtualDamper damper) {
    const BoundedStiffness there = limits_of(candidate.notch).stiffest(damper);
    return there.stiffness < candidate.stiffest.stiffness ? there.bound : WallBound::none;
  }

  [[nodiscard]] WallBounds bounds_of(const Candidate& candidate) {
    WallBounds bounds;
    bounds.stiffness = candidate.stiffest.bound;
    VirtualDamper damper = candidate.damper;
    const double period = device_.loop().sampling_period;
    damper.damping =
        damper.damping > 0.0 ? more_damping * damper.damping : first_damping * candidate.stiffest.stiffness * period;
    bounds.damping = bound_with(candidate, damper);
    if (candidate.damper.velocity_filter_hz > 0.0 && candidate.damper.damping > 0.0) {
      const double cutoff = faster * candidate.damper.velocity_filter_hz;
      bounds.velocity_filter =
          bound_with(candidate, {candidate.damper.damping, cutoff < fastest / period ? cutoff : 0.0});
    }
    return bounds;
  }

  /// With everything that stands behind it; `trust` says what the check found.
  [[nodiscard]] RecommendedWall described(Kind kind, const Candidate& candidate, Trust& trust) {
    WallLimits& limits = limits_of(candidate.notch);
    VirtualDamper damper = candidate.damper;
    if (damper.damping == 0.0) damper.velocity_filter_hz = 0.0;
    const Device walled = with_wall(limits.device(), candidate.stiffest.stiffness, damper);
    RecommendedWall wall = described_wall(kind, walled, candidate.stiffest.bound, limits, options_, trust);
    wall.notch = candidate.notch;
    if (!trust.refused()) wall.contact_damping_ratio = contact_damping_ratio(walled);
    return wall;
  }

  void add(Kind kind, std::optional<Candidate> candidate, WallRecommendation& result) {
    if (!candidate || !(candidate->stiffest.stiffness > 0.0) || !std::isfinite(candidate->stiffest.stiffness)) return;
    WallRecommendation ignored;
    candidate = lowered(*candidate, ignored);
    if (!candidate) return;
    const auto is_like = [&](const RecommendedWall& other) {
      const auto near = [](double a, double b) { return std::abs(a - b) <= to_be_distinct * std::max(a, b); };
      return near(*other.wall.stiffness, candidate->stiffest.stiffness) &&
             near(other.wall.damping, candidate->damper.damping) && other.notch == candidate->notch;
    };
    if (is_like(*result.wall) || std::ranges::any_of(result.alternatives, is_like)) return;
    Trust trust;
    RecommendedWall wall = described(kind, *candidate, trust);
    add_alternative(std::move(wall), trust, result);
  }

  [[nodiscard]] Candidate with_share(const Candidate& best, double share) {
    return exact({share * best.damper.damping, best.damper.velocity_filter_hz}, best.notch, options_.goal);
  }

  void add_alternatives(const Candidate& best, const std::optional<Candidate>& plain, WallRecommendation& result) {
    add(Kind::no_virtual_damper, exact({0.0, 0.0}, {}, options_.goal), result);
    for (const double share : {0.5, 1.5}) {
      if (best.damper.damping == 0.0) break;
      add(share < 1.0 ? Kind::half_damping : Kind::more_damping, with_share(best, share), result);
    }
    add(Kind::no_velocity_filter, unfiltered_, result);
    if (best.notch) add(Kind::no_notch, plain, result);
    for (const auto& [goal, kind] : {std::pair{WallGoal::stiffness, Kind::stiffest},
                                     {WallGoal::width, Kind::widest},
                                     {WallGoal::critical_damping, Kind::critically_damped}}) {
      if (goal == options_.goal || (goal == WallGoal::critical_damping && !device_.has_bodies())) continue;
      add(kind, other_goal(goal, best), result);
    }
  }

  /// Another goal behind the same filters.
  [[nodiscard]] Candidate other_goal(WallGoal goal, const Candidate& best) {
    const VirtualDamper damper = search_of(best.notch).best(best.damper.velocity_filter_hz, goal).damper;
    return {damper, limits_of(best.notch).stiffest(damper, goal), 0.0, best.notch};
  }

  [[nodiscard]] Finding why_none() {
    using enum FindingCode;
    if (limits_.misses_a_limit()) return {.code = any_grasp_not_known};
    if (limits_.has_users() && limits_.limit({}) == 0.0) return {.code = every_wall_destabilised};
    if (!limits_.has_users() && critical_stiffness(filtered_plant(device_)).status == StiffnessStatus::none_stable) {
      return {.code = no_wall_stable_with_any_damper};
    }
    if (options_.goal == WallGoal::critical_damping) return {.code = no_wall_with_damped_contact};
    return {.code = no_wall_keeps_margins_with_any_filter};
  }

  void remark_on_bounds(WallRecommendation& result) {
    remark_on_resolution(device_, options_, result);
    if (!limits_.has_users()) {
      result.remarks.push_back(warning({.code = FindingCode::no_any_user_limit, .subjects = {{"what", "wall"}}}));
    }
    if (limits_.has_users() && device_.parameters().coordinates) {
      (void)limits_.limit({});
      for (Remark& each : any_grasp_remarks(device_, !limits_.misses_a_limit())) {
        result.remarks.push_back(std::move(each));
      }
    }
    if (!device_.parameters().wall.filters.empty()) {
      result.remarks.push_back(note({.code = FindingCode::filters_stay, .key = "wall.filter"}));
    }
  }

  /// The options of the parts, whose progress is that of the stage.
  [[nodiscard]] static RecommendationOptions told(RecommendationOptions options, const StagedProgress& stages) {
    options.progress = stages.stage();
    return options;
  }

  StagedProgress stages_;
  Device device_;
  RecommendationOptions options_;
  WallLimits limits_;
  WallSearch search_;
  std::unique_ptr<WallLimits> notched_;
  std::optional<WallSearch> notched_search_;
  WallLowering lowering_;
  std::vector<WallSearch::Found> found_;
  std::optional<Candidate> unfiltered_;
};

WallRecommendation recommended(const Device& device, const RecommendationOptions& options) {
  const bool is_damper = options.goal == WallGoal::damper;
  const Device unwalled = without_wall(device);
  if (has_damper_loop(device.loop())) {
    return is_damper ? recommend_two_rate_damper(unwalled, options) : recommend_two_rate_wall(unwalled, options);
  }
  if (is_damper) return recommend_damper(unwalled, options);
  WallRecommendation result = Recommendation(device, options).answer();
  const bool is_like = options.goal == WallGoal::stiffness || options.goal == WallGoal::width;
  if (options.drive_damper && is_like && result.wall && !is_of_mechanism(device)) {
    result.drive_damper = recommend_drive_damper(unwalled, options, *result.wall);
  }
  return result;
}

/// Bounds the force per count as RecommendationOptions::quantisation_force says where none is asked.
RecommendationOptions bounded(RecommendationOptions options, const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  if (!options.quantisation_force && parameters.sensor.resolution > 0.0)
    options.quantisation_force = parameters.actuator.force_limit;
  return options;
}

void note_force_per_count(const Device& device, WallRecommendation& result) {
  if (!result.wall || !result.wall->force_per_count) return;
  result.remarks.push_back(note({.code = FindingCode::no_ripple_asked,
                                 .evidence = {{"force_per_count", result.wall->force_per_count->largest,
                                               units_of(device.parameters().motion).force}}}));
}

WallRecommendation refused(Trust trust) {
  WallRecommendation result;
  result.status = WallRecommendation::Status::refused;
  result.trust = std::move(trust);
  return result;
}

}  // namespace

WallRecommendation internal::recommended_wall(const Device& device, const RecommendationOptions& options) {
  require_known_structure(device);
  if (!knows_all_users(device)) require_one_rate(device);
  require_valid(find_problem(options, device));
  Trust trust = trust_of(device);
  if (trust.refused()) return refused(std::move(trust));
  try {
    trust.inherit(critical_stiffness(without_wall(device)).trust);
    if (trust.refused()) return refused(std::move(trust));
    WallRecommendation result = recommended(device, bounded(options, device));
    if (!options.quantisation_force) note_force_per_count(device, result);
    trust.inherit(result.trust);
    result.trust = trust;
    return result;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    trust.refuse({.code = FindingCode::not_converged, .subjects = {{"reason", error.what()}}});
    return refused(std::move(trust));
  }
}

WallRecommendation recommend_wall(const Device& device, const RecommendationOptions& options) {
  constexpr double wall_share = 0.9;  // of the progress
  StagedProgress stages(options.progress);
  stages.next(wall_share);
  RecommendationOptions staged = options;
  staged.progress = stages.stage();
  WallRecommendation result = recommended_wall(device, staged);
  stages.next(1.0);
  if (!result.trust.refused()) result.limits = holding_limits(device, {.progress = stages.stage()});
  stages.done();
  return result;
}

}  // namespace zwidth
