#include "zwidth/design/design_target.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>

#include "counted.hpp"
#include "design/sensitivities/agreeing_difference.hpp"
#include "design/sensitivities/design_parameter.hpp"
#include "design/sensitivities/number_limit.hpp"
#include "design/sensitivities/two_rate_sensitivity.hpp"
#include "design/synthesis/absolute_stability_check.hpp"
#include "design/synthesis/drive_damper.hpp"
#include "design/synthesis/followed_numbers.hpp"
#include "design/synthesis/limit_along_parameter.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "infinity.hpp"
#include "model/known_structure.hpp"
#include "stability/users/any_grasp.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double steps_per_decade = 12.0;
constexpr double steps_per_decade_absolute_stability = 6.0;
constexpr std::uintmax_t max_refinements = 200;
constexpr double reached = 1e-10;      // relative difference of the limit to the target
constexpr double jump_width = 1e-9;    // relative, of the bracket of a jump: closer by, a touch takes seconds to prove
constexpr double least_jump = 1e-3;    // relative
constexpr double beyond = 1.0 + 1e-6;  // a limit that is not to be told from one further up
constexpr double first_share = 1e-3;   // of a number that is 0 now: of the value at which its unit matters

// A value of the number with its limit.
struct Point {
  double value = 0.0;
  double limit = 0.0;
};

class Search {
 public:
  Search(const Device& device, const DesignTargetOptions& options, double limit_now,
         const AbsoluteStabilityCheck& users, SharedProgress& progress)
      : device_(device), options_(options), limit_now_(limit_now), users_(users), progress_(progress) {}

  [[nodiscard]] DesignTarget target_of(const DesignParameter& parameter) const {
    DesignTarget target{parameter.key, parameter.value, std::nullopt, {}, {}, {}};
    LimitAlongParameter moved(device_, parameter, options_.goal, options_.limit_of);
    if (!moved.is_known()) {
      target.why = {.code = FindingCode::left_out_beside_damper_loop, .subjects = {{"what", "any_user"}}};
      return target;
    }
    const Point now{parameter.value, limit_now_};
    std::vector<Walk> walks;
    if (parameter.value > 0.0) {
      walks.push_back({now, parameter.value, parameter.value / options_.factor, 1});
      walks.push_back({now, parameter.value, parameter.value * options_.factor, 1});
    } else {
      const double size = difference_step(parameter, device_.parameters(), target_stiffness(), 0.0).unit;
      walks.push_back({now, first_share * size, options_.factor * size, 0});
    }
    Extremes extremes{limit_now_, limit_now_, {}};
    target.value_needed = first_crossing(parameter, moved, std::move(walks), extremes);
    if (!target.value_needed) {
      find_most(moved, extremes);
      target.why = moved.refused_at() ? Finding{.code = FindingCode::limit_refused_at_value,
                                                .subjects = {{"reason", *moved.refused_at()}}}
                                      : reason_of_none(parameter, extremes);
      return target;
    }
    const Device changed = with(parameter, *target.value_needed);
    const NumberLimit there = number_limit(changed, options_.limit_of);
    if (there.trust.refused()) {
      target.value_needed.reset();
      target.why = {.code = FindingCode::limit_refused_at_value, .subjects = {{"reason", there.trust.reasons.front()}}};
    } else {
      target.why = reason_there(there, limit_at(moved, *target.value_needed, 2.0 * options_.stiffness).value_or(0.0));
      const AbsoluteStabilityCheck::Judgement judgement = users_.of(changed);
      target.absolute_stability_limit_then = judgement.then;
      target.safe = judgement.safe;
    }
    return target;
  }

 private:
  static constexpr int ended = -1;

  [[nodiscard]] double target_stiffness() const {
    return options_.limit_of == WallNumber::stiffness ? options_.stiffness
                                                      : options_.stiffness / device_.loop().sampling_period;
  }

  struct Extremes {
    double least = 0.0;
    double most = 0.0;
    std::vector<Point> bounds;  // below the target, of limits that were not asked for
  };

  [[nodiscard]] std::optional<double> limit_at(LimitAlongParameter& moved, double value, double most) const {
    const auto limit = look_at(moved, value, {.most = most});
    return limit ? std::optional(limit->stiffness) : std::nullopt;
  }

  [[nodiscard]] std::optional<LimitAlongParameter::Limit> look_at(LimitAlongParameter& moved, double value,
                                                                  const LimitAlongParameter::Interest& interest) const {
    progress_.go_on();
    return moved.at(value, interest);
  }

  // Asks for those limits that may be the highest.
  void find_most(LimitAlongParameter& moved, Extremes& extremes) const {
    std::ranges::sort(extremes.bounds, std::greater{}, &Point::limit);
    for (const Point& bound : extremes.bounds) {
      if (bound.limit <= extremes.most) return;
      const auto limit = look_at(moved, bound.value, {beyond * beyond * extremes.most, options_.stiffness});
      if (limit && !limit->is_bound) extremes.most = std::max(extremes.most, limit->stiffness);
    }
  }

  [[nodiscard]] double excess(double limit) const { return limit - options_.stiffness; }

  // By equal factors from `start` to `end`.
  struct Walk {
    Point last;
    double start;
    double end;
    int step;  // the next one
  };

  // The value nearest to today's at which the limit passes the target: the walks go side by side, so that the first to
  // get there has it.
  [[nodiscard]] std::optional<double> first_crossing(const DesignParameter& parameter, LimitAlongParameter& moved,
                                                     std::vector<Walk> walks, Extremes& extremes) const {
    const double density = options_.goal == StiffnessGoal::absolute_stability_limit
                               ? steps_per_decade_absolute_stability
                               : steps_per_decade;
    std::optional<double> nearest;
    while (!nearest && !walks.empty()) {
      for (Walk& walk : walks) {
        const int steps = static_cast<int>(std::ceil(density * std::abs(std::log10(walk.end / walk.start))));
        const double value = walk.start * std::pow(walk.end / walk.start, static_cast<double>(walk.step) / steps);
        // Of limits above the target the least counts.
        const LimitAlongParameter::Interest interest{options_.stiffness,
                                                     beyond * std::max(options_.stiffness, extremes.least)};
        const auto limit = walk.step <= steps ? look_at(moved, value, interest) : std::nullopt;
        walk.step = limit ? walk.step + 1 : ended;
        if (!limit) continue;
        const Point next{value, limit->stiffness};
        if (limit->is_bound) {
          extremes.bounds.push_back(next);
        } else {
          extremes.least = std::min(extremes.least, limit->stiffness);
          extremes.most = std::max(extremes.most, limit->stiffness);
        }
        if ((excess(walk.last.limit) >= 0.0) != (excess(next.limit) >= 0.0)) {
          const std::optional<double> there = refined(moved, walk.last, next);
          if (there && (!nearest || distance(parameter, *there) < distance(parameter, *nearest))) nearest = there;
          if (!there) walk.step = ended;
        }
        walk.last = next;
      }
      std::erase_if(walks, [](const Walk& walk) { return walk.step == ended; });
    }
    return nearest;
  }

  static double distance(const DesignParameter& parameter, double value) {
    return std::abs(std::log(value / parameter.value));
  }

  // Between two values on either side of the target: where the limit is the target; at a jump the side that has it.
  // A bound in place of a limit is on the same side.
  [[nodiscard]] std::optional<double> refined(LimitAlongParameter& moved, Point a, Point b) const {
    bool lost = false;
    double nearest = 1.0;      // of the limits found to the target, relative
    std::vector<Point> found;  // differences: the ends are asked for again
    const auto difference = [&](double value) {
      const auto known = std::ranges::find(found, value, &Point::value);
      if (known != found.end()) return known->limit;
      const std::optional<double> limit = limit_at(moved, value, 2.0 * options_.stiffness);
      if (!limit) lost = true;
      const double apart = limit ? std::clamp(excess(*limit) / options_.stiffness, -1.0, 1.0) : 0.0;
      nearest = std::min(nearest, std::abs(apart));
      found.push_back({value, apart});
      return apart;
    };
    const auto is_done = [&](double left, double right) {
      const bool is_jump = nearest > least_jump && std::abs(right - left) <= jump_width * std::abs(left);
      return is_jump || nearest <= reached || boost::math::tools::eps_tolerance<double>(52)(left, right);
    };
    const auto [low, high] = std::minmax(a.value, b.value);
    const double at_low = std::clamp(excess(a.value <= b.value ? a.limit : b.limit) / options_.stiffness, -1.0, 1.0);
    const double at_high = std::clamp(excess(a.value <= b.value ? b.limit : a.limit) / options_.stiffness, -1.0, 1.0);
    std::uintmax_t iterations = max_refinements;
    const auto [left, right] =
        boost::math::tools::toms748_solve(difference, low, high, at_low, at_high, is_done, iterations);
    if (lost) return std::nullopt;
    const double at_left = difference(left);
    const double at_right = difference(right);
    if (std::min(std::abs(at_left), std::abs(at_right)) <= reached) {
      return std::abs(at_left) <= std::abs(at_right) ? left : right;
    }
    return at_left >= 0.0 ? left : right;  // a jump
  }

  [[nodiscard]] Device with(const DesignParameter& parameter, double value) const {
    DeviceParameters moved = device_.parameters();
    set_with_ratio(moved, parameter.key, value);
    return Device(std::move(moved));
  }

  [[nodiscard]] Finding reason_there(const NumberLimit& there, double limit) const {
    using enum FindingCode;
    if (std::abs(excess(limit)) > reached * options_.stiffness) return {.code = limit_jumps_across_target};
    if (options_.goal == StiffnessGoal::absolute_stability_limit) return {.code = any_user_limit_at_target};
    if (there.at->limited_by.kind == Oscillator::Kind::rigid_body) return {.code = rigid_body_limit_at_target};
    return {.code = mode_limit_at_target, .evidence = {{"mode", static_cast<double>(there.at->limited_by.mode)}}};
  }

  [[nodiscard]] Finding reason_of_none(const DesignParameter& parameter, const Extremes& extremes) const {
    const bool below = extremes.most < options_.stiffness;
    const double nearest = below ? extremes.most : extremes.least;
    const bool is_stiffness = options_.limit_of == WallNumber::stiffness;
    if (!std::isfinite(nearest)) {
      return {.code = FindingCode::stable_at_every_value, .subjects = {{"what", is_stiffness ? "wall" : "damper"}}};
    }
    const Units units = units_of(device_.parameters().motion);
    const std::string_view unit = is_stiffness ? units.stiffness : units.damping;
    Finding why{.code = below ? FindingCode::limit_stays_below_target : FindingCode::limit_stays_above_target,
                .evidence = {{"limit", nearest, unit}, {"threshold", options_.stiffness, unit}}};
    if (parameter.value > 0.0) why.evidence.push_back({"factor", options_.factor});
    return why;
  }

  const Device& device_;
  const DesignTargetOptions& options_;
  double limit_now_;
  const AbsoluteStabilityCheck& users_;
  SharedProgress& progress_;
};

// Where in the answer: relative change, then numbers that are 0 now; what lowers the limit with any passive user after
// those, and what has no value last.
std::pair<int, double> cost(const DesignTarget& target) {
  if (!target.value_needed) return {2, 0.0};
  const double change = target.value_now > 0.0 ? std::abs(std::log(*target.value_needed / target.value_now)) : infinity;
  return {target.safe.value_or(true) ? 0 : 1, change};
}

// The limit to reach, where there is one.
std::optional<double> target_of(const DesignTargetOptions& options, double limit_now) {
  if (!options.times_now) return options.stiffness;
  const double target = *options.times_now * limit_now;
  return target > 0.0 && std::isfinite(target) ? std::optional(target) : std::nullopt;
}

}  // namespace

std::optional<OptionProblem> find_problem(const DesignTargetOptions& options, const Device& device) {
  if (options.times_now && (!(*options.times_now > 0.0) || !std::isfinite(*options.times_now))) {
    return option_problem("times_now", {.code = ProblemCode::not_finite_and_positive,
                                        .evidence = {{"value", *options.times_now}, {"times", 1.0}}});
  }
  if (!options.times_now && (!(options.stiffness > 0.0) || !std::isfinite(options.stiffness))) {
    return option_problem("stiffness",
                          {.code = ProblemCode::not_finite_and_positive, .evidence = {{"value", options.stiffness}}});
  }
  if (!(options.factor > 1.0) || !(options.factor <= 1e6)) {
    return option_problem("factor", {.code = ProblemCode::no_factor, .evidence = {{"value", options.factor}}});
  }
  if (options.goal == StiffnessGoal::absolute_stability_limit) {
    if (!device.is_mechanical()) {
      return option_problem("goal", {.code = ProblemCode::any_user_goal_of_transfer_function});
    }
    if (device.degrees_of_freedom() > most_bodies_for_absolute_stability) {
      return option_problem("goal", {.code = ProblemCode::any_user_goal_of_many_bodies,
                                     .evidence = {counted("bodies", device.degrees_of_freedom()),
                                                  counted("most", most_bodies_for_absolute_stability)}});
    }
  }
  return std::nullopt;
}

DesignTargets design_targets(const Device& device, const DesignTargetOptions& options) {
  require_known_structure(device);
  require_valid(find_problem(options, device));
  DesignTargets result;
  const NumberLimit own = number_limit(device, options.limit_of);
  result.trust = own.trust;
  if (result.trust.refused()) return result;
  const bool has_two_loops = has_damper_loop(device.loop());
  std::vector<DesignParameter> parameters = has_two_loops ? numbers_of_two_rates(device) : design_parameters(device);
  // Who holds the device is no part of it, nor is where it stands.
  std::erase_if(parameters, [&](const DesignParameter& each) {
    const bool is_the_limit =
        each.kind == DesignParameter::Kind::wall_damping && options.limit_of == WallNumber::damping;
    const bool is_pose = each.kind == DesignParameter::Kind::joint_position;
    return is_the_limit || is_pose || each.key.starts_with("operator.");
  });
  SharedProgress progress(options.progress, parameters.size());
  const Progress while_judging = [&progress](double) { progress.go_on(); };
  result.limits = holding_limits(device, {.progress = while_judging});
  const AbsoluteStabilityCheck users(device, options.limit_of, while_judging);
  result.absolute_stability_limit_now = users.now();
  if (can_be_held(device)) {
    for (Remark& each : any_grasp_remarks(device, users.now().has_value())) result.remarks.push_back(std::move(each));
  }
  double limit = own.value;
  if (options.goal == StiffnessGoal::absolute_stability_limit) {
    auto any_user = users.limit_now();
    // Where it is not found, this says why.
    if (!any_user) any_user = absolute_stability_limit_of(device, options.limit_of, while_judging);
    if (!any_user) require_one_rate(device);
    result.trust.inherit(any_user->trust);
    if (result.trust.refused()) return result;
    limit = std::min(limit, any_user->value);
  }
  result.limit_now = limit;
  result.target = target_of(options, limit);
  if (!result.target) {
    result.remarks.push_back(
        warning({.code = limit > 0.0 ? FindingCode::every_one_stable : FindingCode::none_stable,
                 .subjects = {{"what", options.limit_of == WallNumber::stiffness ? "wall" : "damper"}}}));
    return result;
  }
  if (has_two_loops && device.loop().damper->sampling_period) {
    result.remarks.push_back(note({.code = FindingCode::damper_period_follows, .key = "loop.damper.sampling_period"}));
  }
  if (limit == *result.target) {
    result.remarks.push_back(note({.code = FindingCode::limit_is_target, .evidence = {{"target", limit}}}));
  }
  DesignTargetOptions asked = options;
  asked.stiffness = *result.target;
  std::vector<DesignParameter> left_out;
  if (options.goal == StiffnessGoal::absolute_stability_limit && users.limit_now()) {
    const std::size_t all = parameters.size();
    left_out = take_out_least(device, options.limit_of, users.limit_now()->frequency, while_judging, parameters);
    if (!left_out.empty()) {
      asked.factor = std::min(options.factor, factor_of_many_bodies);
      result.remarks.push_back(note({.code = FindingCode::some_numbers_followed,
                                     .evidence = {{"followed", static_cast<double>(parameters.size())},
                                                  {"all", static_cast<double>(all)},
                                                  {"factor", asked.factor},
                                                  {"bodies", static_cast<double>(device.degrees_of_freedom())}}}));
    }
  }
  progress.add(left_out.size());
  result.targets.resize(parameters.size());
  const Search search(device, asked, limit, users, progress);
  tbb::parallel_for(std::size_t{0}, parameters.size(), [&](std::size_t i) {
    result.targets[i] = search.target_of(parameters[i]);
    progress.add();
  });
  for (const DesignParameter& each : left_out) {
    DesignTarget target;
    target.key = each.key;
    target.value_now = each.value;
    target.why = {.code = FindingCode::number_not_followed};
    result.targets.push_back(std::move(target));
  }
  std::ranges::stable_sort(result.targets, {}, cost);
  if (options.limit_of == WallNumber::stiffness && !is_of_mechanism(device)) {
    const bool any_user = options.goal == StiffnessGoal::absolute_stability_limit;
    result.drive_damper = drive_damper(device, any_user, while_judging);
  }
  return result;
}

}  // namespace zwidth
