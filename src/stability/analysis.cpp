#include "zwidth/stability/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "counted.hpp"
#include "model/implausible_numbers.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/point_wall_analysis.hpp"
#include "stability/users/absolute_stability_search.hpp"
#include "stability/users/any_grasp.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "stability/wall_judgement.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/model/two_mass.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/stability/critical_damping.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// Of the rigid model's limit beside the device's; 0 and infinity are limits like others, NaN (refused) is none.
RigidApproximation::Error rigid_error(double rigid, double exact) {
  constexpr double same = 5e-4;
  if (rigid > exact * (1.0 + same)) return RigidApproximation::Error::unsafe;
  return rigid < exact * (1.0 - same) ? RigidApproximation::Error::safe : RigidApproximation::Error::none;
}

RigidApproximation rigid_approximation(const Device& device, const CriticalStiffness& of_device) {
  const User& user = device.parameters().user;
  RigidApproximation rigid{.mass = user.mass, .damping = user.damping, .stiffness = user.stiffness, .critical = {}};
  for (const Body& body : device.bodies()) {
    rigid.mass += body.mass;
    rigid.damping += body.damping;
    rigid.stiffness += body.stiffness;
  }
  if (device.bodies().size() == 1) {
    rigid.critical = of_device;
    return rigid;
  }
  DeviceParameters parameters;
  parameters.name = "rigid";
  parameters.bodies.push_back({"body", rigid.mass, rigid.damping, rigid.stiffness, 0.0});
  parameters.loop.sampling_period = device.loop().sampling_period;
  parameters.loop.delay = device.loop().delay;
  parameters.loop.damper = device.loop().damper;
  parameters.actuator = device.parameters().actuator;
  parameters.wall.filters = device.parameters().wall.filters;
  parameters.wall.damping = device.parameters().wall.damping;
  parameters.wall.velocity_filter_hz = device.parameters().wall.velocity_filter_hz;
  rigid.critical = critical_stiffness(Device(std::move(parameters)));
  rigid.critical.trust.inherit(of_device.trust);
  if (rigid.critical.trust.refused()) withdraw(rigid.critical);
  rigid.error = rigid_error(rigid.critical.stiffness, of_device.stiffness);
  return rigid;
}

std::optional<QCriterion> q_criterion(const Device& device, const RigidApproximation& rigid, Analysis& analysis) {
  const std::optional<TwoMass> two = as_two_mass(device);
  const Wall& wall = device.parameters().wall;
  if (!two || !wall.filters.empty()) return std::nullopt;
  if (has_damper_loop(device.loop())) {
    analysis.remarks.push_back(left_out_beside_damper_loop("q"));
    return std::nullopt;
  }
  const TwoMassFactors factors = two_mass_factors(*two);
  QCriterion criterion{.stiffness = two->motor_mass * factors.z_n * factors.omega_n};  // eq. 24
  if (wall.damping == 0.0 && device.loop().sensed == device.loop().actuated &&
      rigid.critical.status == StiffnessStatus::finite) {
    constexpr double similar = 2.0;
    criterion.mode_matters = criterion.stiffness <= rigid.critical.stiffness;
    criterion.is_similar = criterion.stiffness <= similar * rigid.critical.stiffness;
  }
  return criterion;
}

/// A wall within the interval of the critical stiffness is stable for some of the devices that it allows.
void judge_certainty_of_wall(const Device& device, Analysis& analysis) {
  if (!analysis.wall || !analysis.wall->stable || !analysis.interval) return;
  if (analysis.wall->stiffness < analysis.interval->lower) return;
  const auto unit = units_of(device.parameters().motion).stiffness;
  analysis.trust.doubt(
      {.code = FindingCode::wall_not_surely_stable,
       .evidence = {{"stiffness", analysis.wall->stiffness, unit}, {"lower", analysis.interval->lower, unit}},
       .key = "wall.stiffness"});
}

/// Whether the family of users can be given, which rests on this limit; where not, the analysis says so.
bool stands(const CriticalStiffness& limit, Analysis& analysis) {
  if (!limit.trust.refused()) {
    analysis.trust.inherit(limit.trust);
    return true;
  }
  for (const std::string& reason : limit.trust.reasons) {
    analysis.trust.doubt({.code = FindingCode::left_out, .subjects = {{"reason", reason}}});
  }
  return false;
}

/// The largest damper alone; what is not sure of it is left out and said.
void add_critical_damping(const Device& device, HolderLimit& limit, Analysis& analysis) {
  const CriticalDamping damping = critical_damping(device);
  if (!damping.trust.sound() && analysis.trust.sound()) {
    analysis.remarks.push_back(note(
        {.code = FindingCode::critical_damping_left_out, .subjects = {{"reason", damping.trust.reasons.front()}}}));
  }
  if (!damping.trust.sound()) return;
  limit.critical_damping = damping.damping;
  if (!damping.limit) return;
  limit.damping_frequency = damping.limit->frequency;
  limit.damping_limited_by = damping.limit->limited_by;
}

/// The same device and wall with nobody holding, and with the file's user.
void judge_holders(const Device& device, const AnalysisOptions& options, Analysis& analysis) {
  const bool is_held = device_has_user(device);
  if (analysis.wall) analysis.wall_stable_for = StableFor{.nobody = analysis.wall->stable};
  if (!is_held) {
    analysis.limits.nobody = limit_of_holder(analysis.critical);
    if (options.critical_damping) add_critical_damping(device, analysis.limits.nobody, analysis);
    return;
  }
  const Device free = device_without_user(device);
  Analysis alone = analyze(free, {.any_user = false, .critical_damping = options.critical_damping, .draws = 0});
  for (const std::string& reason : alone.trust.reasons) {
    if (std::ranges::count(analysis.trust.reasons, reason) > 0) continue;
    analysis.trust.doubt({.code = FindingCode::nobody_holding, .subjects = {{"reason", reason}}});
  }
  analysis.limits.nobody = alone.limits.nobody;
  analysis.limits.user = limit_of_holder(analysis.critical);
  if (options.critical_damping) add_critical_damping(device, *analysis.limits.user, analysis);
  if (analysis.wall) {
    analysis.wall_stable_for->user = analysis.wall->stable;
    analysis.wall_stable_for->nobody = alone.wall && alone.wall->stable;
    if (analysis.wall->stable && !analysis.wall_stable_for->nobody) {
      analysis.remarks.push_back(warning({.code = FindingCode::unstable_with_nobody,
                                          .evidence = {{"stiffness", analysis.wall->stiffness}},
                                          .effect = {{"critical_stiffness", alone.critical.stiffness}}}));
    }
  }
  analysis.alone =
      AnswerAlone{std::move(alone.critical), std::move(alone.modes), alone.suspended_rigid_body, std::move(alone.wall)};
}

/// Whether any passive user leaves the wall stable, with the damper alone where it has no spring. Above a lower bound it is
/// not known.
void judge_absolute_stability(const Device& device, Analysis& analysis) {
  if (!analysis.wall_stable_for || !analysis.limits.any_user) return;
  const HolderLimit& limit = *analysis.limits.any_user;
  StableFor& wall = *analysis.wall_stable_for;
  if (analysis.wall->stiffness > 0.0) {
    const bool is_below = analysis.wall->stiffness < limit.critical_stiffness;
    const bool is_bound = !knows_all_users(device) && analysis.wall->damping > 0.0;
    if (is_below || !is_bound || !wall.nobody) wall.any_user = wall.nobody && is_below;
  } else if (limit.critical_damping) {
    wall.any_user = wall.nobody && (analysis.wall->damping == 0.0 || analysis.wall->damping < *limit.critical_damping);
  }
  if (stability_of(wall) != WallStability::alone_only || wall.any_user.value_or(true)) return;
  if (analysis.wall->stiffness > 0.0) {
    analysis.remarks.push_back(warning({.code = FindingCode::stiffer_than_any_user_limit,
                                        .evidence = {{"stiffness", analysis.wall->stiffness}},
                                        .key = "wall.stiffness",
                                        .effect = {{"critical_stiffness", limit.critical_stiffness}}}));
  } else {
    analysis.remarks.push_back(warning({.code = FindingCode::damper_above_any_user_limit,
                                        .evidence = {{"damping", analysis.wall->damping}},
                                        .key = "wall.damping",
                                        .effect = {{"critical_damping", *limit.critical_damping}}}));
  }
}

void answer_absolute_stability(const Device& device, const AnalysisOptions& options, StagedProgress& stages,
                               Analysis& analysis);

/// The same of a damper in a loop of its own.
void answer_beside_damper_loop(const Device& device, const AnalysisOptions& options, StagedProgress& stages,
                               Analysis& analysis) {
  if (device.parameters().wall.damping == 0.0) {  // the spring runs alone
    answer_absolute_stability(with_one_rate(device), options, stages, analysis);
  } else {
    const CriticalStiffness& nobody = analysis.alone ? analysis.alone->critical : analysis.critical;
    analysis.any_user = two_rate_absolute_stability(device, nobody);
    if (!analysis.any_user) return analysis.remarks.push_back(left_out_beside_damper_loop("any_user"));
    analysis.remarks.push_back(any_user_limit_scanned(device.loop()));
    analysis.trust.inherit(analysis.any_user->trust);
    HolderLimit& limit = analysis.limits.any_user.emplace();
    limit.critical_stiffness = analysis.any_user->stiffness;
    if (analysis.any_user->frequency > 0.0) limit.frequency = analysis.any_user->frequency;
  }
  if (!analysis.limits.any_user || !options.critical_damping) return;
  const AbsoluteStabilityDamping of_damper = absolute_stability_damping(device);
  HolderLimit& limit = *analysis.limits.any_user;
  limit.critical_damping.reset();
  limit.damping_frequency.reset();
  if (of_damper.trust.sound()) limit.critical_damping = of_damper.damping;
  if (of_damper.damping > 0.0 && std::isfinite(of_damper.damping)) limit.damping_frequency = of_damper.frequency;
}

/// What a grasp leaves at a singular pose itself is no limit: said beside that of the poses around it.
void add_singular_pose(const Device& device, Analysis& analysis) {
  const std::optional<TipMotion> motion = tip_motion_of(device);
  if (!motion || motion->tips_beside.empty()) return;
  DeviceParameters loop = device.parameters();
  if (!analysis.any_user || !loop.wall.filters.empty()) {
    return analysis.remarks.push_back(singular_pose_remark(*motion));
  }
  loop.loop.damper.reset();
  const double at_pose = any_grasp_limit(*motion, loop, wall_normal(device), GraspedPose::alone).stiffness;
  if (std::isnan(at_pose)) return analysis.remarks.push_back(singular_pose_remark(*motion));
  analysis.remarks.push_back(singular_pose_remark(*motion, std::min(at_pose, analysis.limits.nobody.critical_stiffness),
                                                  analysis.any_user->stiffness));
}

/// The same of a mechanism, whose tip is grasped in any direction; of the stiffness.
void answer_any_grasp(const Device& device, Analysis& analysis) {
  const CriticalStiffness& nobody = analysis.alone ? analysis.alone->critical : analysis.critical;
  const Wall& wall = device.parameters().wall;
  analysis.any_user = any_grasp_absolute_stability(device, {wall.damping, wall.velocity_filter_hz}, nobody);
  add_singular_pose(device, analysis);
  if (!analysis.any_user) return analysis.remarks.push_back(note({.code = FindingCode::any_grasp_not_known}));
  analysis.remarks.push_back(note({.code = FindingCode::any_grasp_scanned}));
  analysis.any_user->trust.inherit(analysis.trust);
  analysis.trust.inherit(analysis.any_user->trust);
  HolderLimit& limit = analysis.limits.any_user.emplace();
  limit.critical_stiffness = analysis.any_user->stiffness;
  if (limit.critical_stiffness > 0.0 && std::isfinite(limit.critical_stiffness)) {
    limit.frequency = analysis.any_user->frequency;
  }
}

/// The limit over all passive users, of the stiffness and of the damper alone.
void answer_absolute_stability(const Device& device, const AnalysisOptions& options, StagedProgress& stages,
                               Analysis& analysis) {
  if (device.degrees_of_freedom() > most_bodies_for_absolute_stability) {
    if (is_grasped_in_many_directions(device)) {
      return analysis.remarks.push_back(note({.code = FindingCode::any_grasp_not_known}));
    }
    analysis.remarks.push_back(note({.code = FindingCode::too_many_bodies_for_any_user,
                                     .evidence = {{"bodies", static_cast<double>(device.degrees_of_freedom())},
                                                  {"most", static_cast<double>(most_bodies_for_absolute_stability)}}}));
    return;
  }
  // That limit rests on the critical stiffness of the device that nobody holds.
  if (std::isnan(analysis.limits.nobody.critical_stiffness)) return;
  if (is_grasped_in_many_directions(device)) return answer_any_grasp(device, analysis);
  if (has_damper_loop(device.loop())) return answer_beside_damper_loop(device, options, stages, analysis);
  const VirtualDamper damper = virtual_damper(device);
  AbsoluteStabilitySearch search(device, stages.stage());
  analysis.any_user = search.limit(damper, stages.stage());
  stages.next(0.4);
  AbsoluteStabilityLimit& any_user = *analysis.any_user;
  if (analysis.interval && options.any_user_draws > 0 &&
      device.bodies().size() <= most_bodies_for_absolute_stability_interval) {
    any_user.interval =
        absolute_stability_interval(device, damper, options.any_user_draws, usual_draws_seed, stages.stage());
    stages.next(0.4);
  }
  any_user.trust.inherit(analysis.trust);
  analysis.trust.inherit(any_user.trust);
  HolderLimit& limit = analysis.limits.any_user.emplace();
  limit.critical_stiffness = any_user.stiffness;
  if (any_user.stiffness > 0.0 && std::isfinite(any_user.stiffness)) limit.frequency = any_user.frequency;
  if (options.critical_damping) {
    const AbsoluteStabilityLimit of_damper = search.damping_limit(damper.velocity_filter_hz, stages.stage());
    if (of_damper.trust.sound()) limit.critical_damping = of_damper.stiffness;
    if (of_damper.stiffness > 0.0 && std::isfinite(of_damper.stiffness)) limit.damping_frequency = of_damper.frequency;
  }
  if (options.worst_user) analysis.worst_user = worst_user(device, any_user, damper, stages.stage());
}

/// The users: what is asked for and can be answered.
void answer_about_users(const Device& device, const AnalysisOptions& options, StagedProgress& stages,
                        Analysis& analysis) {
  if (options.any_user && device.is_mechanical()) answer_absolute_stability(device, options, stages, analysis);
  judge_absolute_stability(device, analysis);
  if (!options.family) return;
  stages.next(1.0);
  const UserFamily family = user_family(*options.family, device.parameters().user);
  UserFamilyAnswer answer{family, worst_of_family(device, family, virtual_damper(device), stages.stage()),
                          critical_stiffness(device_without_user(device))};
  if (stands(answer.free, analysis) &&
      stands(critical_stiffness(device_with_user(device, answer.worst.user)), analysis)) {
    analysis.user_family = std::move(answer);
  }
}

std::optional<OptionProblem> find_problem(const std::optional<ValueRange>& range, const char* member) {
  if (!range || (range->least >= 0.0 && range->greatest >= range->least && std::isfinite(range->greatest))) {
    return std::nullopt;
  }
  return option_problem(member, {.code = ProblemCode::range_not_possible,
                                 .evidence = {{"least", range->least}, {"greatest", range->greatest}}});
}

}  // namespace

std::optional<OptionProblem> find_problem(const AnalysisOptions& options) {
  if (options.worst_user && !options.any_user) {
    return option_problem("worst_user", {.code = ProblemCode::needs_any_user});
  }
  if (options.family) {
    if (auto problem = find_problem(options.family->mass, "family.mass")) return problem;
    if (auto problem = find_problem(options.family->damping, "family.damping")) return problem;
    if (auto problem = find_problem(options.family->stiffness, "family.stiffness")) return problem;
  }
  return std::nullopt;
}

std::optional<OptionProblem> find_problem(const AnalysisOptions& options, const Device& device) {
  if (auto problem = find_problem(options)) return problem;
  const char* asked = options.worst_user ? "worst_user" : options.family ? "family" : nullptr;
  if (asked == nullptr) return std::nullopt;
  if (!device.has_bodies()) {
    const bool is_mechanism = device.is_mechanical();
    return option_problem(asked,
                          {.code = is_mechanism ? ProblemCode::coordinates_not_known : ProblemCode::no_body_to_hold});
  }
  if (has_damper_loop(device.loop())) return option_problem(asked, {.code = ProblemCode::damper_loop_not_known});
  if (options.worst_user && device.bodies().size() > most_bodies_for_absolute_stability) {
    return option_problem("worst_user", {.code = ProblemCode::too_many_bodies,
                                         .evidence = {counted("bodies", device.bodies().size()),
                                                      counted("most", most_bodies_for_absolute_stability)}});
  }
  return std::nullopt;
}

Analysis analyze(const Device& device, const AnalysisOptions& options) {
  require_valid(find_problem(options, device));
  if (is_point_wall(device)) return point_wall_analysis(device, options);
  ModalForm form = modal_form(device);
  Analysis analysis;
  analysis.remarks = implausible_numbers(device);
  StagedProgress stages(options.progress);
  stages.next(0.05);
  std::optional<OneRate> one_rate;
  if (!has_damper_loop(device.loop())) one_rate.emplace(device, form);
  analysis.critical =
      one_rate ? guarded_stiffness(device, one_rate->plant, one_rate->poles) : critical_stiffness(device);
  analysis.trust = analysis.critical.trust;
  analysis.modes = std::move(form.modes);
  analysis.suspended_rigid_body = form.suspended_rigid_body;
  if (device.has_bodies()) {
    analysis.rigid = rigid_approximation(device, analysis.critical);
    analysis.q_criterion = q_criterion(device, *analysis.rigid, analysis);
  }
  stages.next(0.1);
  if (analysis.trust.refused()) return analysis;
  if (device.parameters().wall.stiffness) {
    if (one_rate) judge_wall(device, one_rate->plant, one_rate->poles, analysis);
    if (!one_rate) judge_two_rate_wall(device, analysis);
  }
  if (analysis.trust.refused()) return analysis;
  stages.next(0.3);
  analysis.force_per_count = force_per_count(device);
  analysis.quantisation = quantisation_passivity(device);
  const std::optional<Uncertainty>& uncertainty = device.parameters().uncertainty;
  if (uncertainty && !uncertainty->parameters.empty() && options.draws > 0) {
    analysis.interval = stiffness_interval(device, options.draws, usual_draws_seed, stages.stage());
    if (is_inconclusive(*analysis.interval)) {
      analysis.trust.doubt({.code = FindingCode::interval_open,
                            .evidence = {{"lower", analysis.interval->lower}, {"upper", analysis.interval->upper}}});
    }
  }
  judge_certainty_of_wall(device, analysis);
  judge_holders(device, options, analysis);
  stages.next(0.35);
  answer_about_users(device, options, stages, analysis);
  judge_damping_of_wall(analysis);
  stages.done();
  return analysis;
}

WallVerdict verdict_on_wall(const Analysis& analysis) {
  if (!analysis.trust.sound()) return WallVerdict::unsure;
  if (!analysis.wall) return WallVerdict::no_wall;
  return stability_of(*analysis.wall_stable_for) == WallStability::unstable ? WallVerdict::unstable
                                                                            : WallVerdict::stable;
}

HoldingLimits holding_limits(const Device& device, const HoldingOptions& options) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness.reset();
  return analyze(Device(std::move(parameters)), {.any_user = options.any_user,
                                                 .critical_damping = options.critical_damping,
                                                 .draws = 0,
                                                 .progress = options.progress})
      .limits;
}

}  // namespace zwidth
