#include "identification/friction_in_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "identification/response/encoder_step.hpp"
#include "identification/fit_judgement.hpp"
#include "identification/friction_fit.hpp"
#include "identification/friction_test.hpp"
#include "identification/shot_covariance.hpp"
#include "identification/shot_fit.hpp"
#include "identification/shot_noise.hpp"
#include "identification/shot_search.hpp"
#include "identification/time_domain_start.hpp"
#include "simulation/continuous_motion.hpp"
#include "zwidth/error.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

/// Those that move, the heaviest first.
std::vector<Body> moving_bodies(const Device& device, const std::vector<std::string>& locked) {
  std::vector<Body> bodies = device.bodies();
  std::erase_if(bodies, [&](const Body& body) { return std::ranges::count(locked, body.name) > 0; });
  std::ranges::stable_sort(bodies, std::greater{}, &Body::mass);
  return bodies;
}

/// K_CR without the friction.
double stiffness_beside(DeviceParameters parameters) {
  for (Body& body : parameters.bodies) body.coulomb = 0.0;
  return limit_of(Device(std::move(parameters))).stiffness;
}

/// A friction, and what it explains.
struct FrictionBeside {
  ShownFriction friction;
  double gain = 0.0;          ///< of the log-likelihood, over the linear device's: a side minimum loses
  bool is_held = false;       ///< not the best one: more of it, that the record does not exclude
  bool is_of_a_part = false;  ///< of the record, the rest of which may exclude it
};

bool is_far_below(double stiffness, const Analysis& analysis) {
  constexpr double far = 0.9;
  return stiffness < far * analysis.interval->lower;
}

bool is_suspected(const ShownFriction& friction) {
  constexpr double deviations = 2.0;
  return friction.force > deviations * friction.deviation;
}

/// Two deviations; a side minimum gains less.
constexpr double least_gain = 2.0;

/// By four deviations.
bool is_clear(const FrictionBeside& beside) { return beside.gain > 8.0; }

/// What a friction found in time says of a fit.
enum class Meaning : std::uint8_t { nothing, may_matter, shows };

Meaning meaning_of(const FrictionBeside& beside, const Analysis& analysis) {
  const ShownFriction& friction = beside.friction;
  // Where damping and friction look alike, as under a force that repeats, no deviation tells how much is which. Of 114 right
  // answers none came so far below its interval; of six that began 15 to 190 % above the truth all did.
  const bool is_far = is_far_below(*friction.stiffness_beside, analysis);
  if (beside.is_held) return is_far ? Meaning::may_matter : Meaning::nothing;
  if (beside.gain < least_gain) return is_far ? Meaning::may_matter : Meaning::nothing;
  if (friction.force > significant_friction * friction.deviation) return Meaning::shows;
  // Below, the fit in time may as well have ended in a side minimum.
  const double notable = is_clear(beside) ? 0.96 : 0.95;  // of the linear fit's: its interval moves by as much
  const bool matters = is_suspected(friction) && *friction.stiffness_beside < notable * analysis.critical.stiffness;
  constexpr double below = 0.99;  // a drift passes for a friction that moves the limit by less
  const bool is_beside_the_answer = is_clear(beside) && *friction.stiffness_beside < below * analysis.interval->lower;
  return matters || is_beside_the_answer || is_far ? Meaning::may_matter : Meaning::nothing;
}

/// Of a friction that may matter or shows: whether the answer is another with it than without. Within the interval, where it
/// explains the record clearly and moves the interval by more than half of its lower part.
bool changes_the_answer(const FrictionBeside& beside, const Analysis& analysis) {
  const double lower = analysis.interval->lower;
  const double middle = 0.5 * (lower + analysis.critical.stiffness);
  const double most = is_clear(beside) && is_suspected(beside.friction) ? middle : lower;
  return meaning_of(beside, analysis) == Meaning::shows || *beside.friction.stiffness_beside < most;
}

/// The best friction of a fit, and what else the fit tells of it.
struct DescribedFriction {
  FrictionBeside found;
  Eigen::VectorXd along;  ///< of x, for a deviation of the friction
};

/// Of `body`, element `at` of x. Nothing where the friction is not determined, or would have held the device.
std::optional<DescribedFriction> describe(const Follower& follower, const FrictionFit& fit, Eigen::Index at,
                                          const std::string& body, bool is_of_a_part) {
  const ShotModel& model = follower.model;
  const FittedShots& best = fit.best;
  const Eigen::VectorXd& x = best.fit.x;
  const auto slopes = shot_slopes(model, follower.shots, best.noise, x, best.fit.states);
  if (!slopes) return std::nullopt;
  const ShotCovariance known = shot_covariance(*slopes, std::vector<bool>(static_cast<std::size_t>(x.size()), false));
  const double variance = known.covariance(at, at);
  if (!(variance > 0.0)) return std::nullopt;
  const double unit = model.coordinates()[static_cast<std::size_t>(at)].slope(x(at));
  // A body alone that rubs as strongly as it is pushed would not have moved.
  const auto [least, most] = std::ranges::minmax(model.records().front().force);
  const double strongest = std::max(std::abs(least), std::abs(most));
  if (model.states() == 2 && x(at) * unit >= strongest) return std::nullopt;
  const double deviation = std::sqrt(variance);
  return DescribedFriction{{{body, x(at) * unit, deviation * unit, stiffness_beside(model.parameters_at(x))},
                            fit.gain(),
                            false,
                            is_of_a_part},
                           known.covariance.col(at) / deviation};
}

/// What more friction than the best showed: one that the record does not exclude and beside which K_CR lies far below the
/// interval, or else a better fit than the best.
struct MoreFriction {
  std::optional<FrictionBeside> far;
  std::optional<FrictionFit> better;
};

/// Up to two deviations more. The fit is repeated: slopes, which point out where to look, hold for a small way only near stick
/// and slip.
MoreFriction more_friction(const Follower& follower, const FrictionFit& fit, Eigen::Index at,
                           const DescribedFriction& best, const Analysis& analysis) {
  const auto& [model, search, shots] = follower;
  const Eigen::VectorXd& x = fit.best.fit.x;
  const bool is_of_a_part = best.found.is_of_a_part;
  constexpr std::array shares{0.1, 0.3, 1.0, 2.0};  // of the deviation
  const auto may_be_far = [&](double share) {
    try {
      constexpr double nearly = 0.95;  // slopes hold for a small way only
      return stiffness_beside(follower.model.parameters_at(x + share * best.along)) < nearly * analysis.interval->lower;
    } catch (const Error&) {  // so far that a damping is negative
      return true;
    }
  };
  MoreFriction more;
  if (std::ranges::none_of(shares, may_be_far)) return more;
  double most = std::max(0.0, best.found.gain);
  FittedShots from = fit.best;
  for (const double share : shares) {
    auto held = with_held_friction(follower, from.fit, at, x(at) + share * best.along(at), fit.best.noise);
    if (!held) continue;
    const double gain = fit.linear_badness - search.badness(*held, shots);
    if (!is_of_a_part) most = std::max(most, gain);  // of a part the whole will tell
    const bool is_as_good = gain > as_much && (is_of_a_part || gain > most + as_much);
    if (!is_as_good) continue;
    from = *std::move(held);  // a small way on, states and all: from those of the record a search ends in side minima
    const double stiffness = stiffness_beside(model.parameters_at(from.fit.x));
    if (!is_far_below(stiffness, analysis)) continue;
    ShownFriction friction = best.found.friction;
    friction.force += share * friction.deviation;
    friction.stiffness_beside = stiffness;
    more.far = FrictionBeside{std::move(friction), gain, true, is_of_a_part};
    return more;
  }
  if (most > std::max(0.0, best.found.gain) + least_gain) {
    more.better = with_free_friction(follower, from, fit.linear_badness);
  }
  return more;
}

/// How much of a record is played: what most records need, and what one needs of which a part leaves friction open.
constexpr double cost_of_a_part = 2.5e6;
constexpr double cost_of_the_whole = 16.0 * cost_of_a_part;

constexpr std::size_t shortest = 512;  // samples
constexpr double most_steps = 60.0;    // a sample

/// Of the motion of a device through each sample.
double steps_per_sample(const Device& device, const std::vector<std::string>& locked, double sampling_period) {
  const Device played = without_short_lag(device_in_experiment(device, locked, sampling_period));
  return ContinuousMotion(played, {}, {}).rate() * sampling_period;
}

/// Whether the motion can be followed at all.
bool can_be_asked(const Identification& result, const std::vector<std::string>& locked, const Recording& recording) {
  return recording.channels[0].samples.size() >= shortest &&
         steps_per_sample(result.fit.device, locked, recording.sampling_period) <= most_steps;
}

/// Whether more than the best friction is asked after.
enum class AsksMore : std::uint8_t { no, yes };

/// Friction of a body beside all numbers of the fit; nothing where no such motion can be followed, or it explains less.
std::optional<FrictionBeside> friction_beside(const Identification& result, const Body& body,
                                              const std::vector<std::string>& locked, const Recording& recording,
                                              double most_cost, AsksMore asks_more) {
  const ParameterFit& fit = result.fit;
  const std::span one(&recording, 1);
  const MotionRecord record{recording.channels[0].samples, recording.channels[1].samples, recording.sampling_period};
  DeviceParameters parameters = fit.device.parameters();
  parameters.uncertainty.reset();
  const Device linear(std::move(parameters));
  TimeDomainStart start{.device = linear, .free = keys_of(fit)};
  start.free.push_back("body." + body.name + ".coulomb");

  const double steps = steps_per_sample(start.device, locked, record.sampling_period);
  constexpr double stiffer = 2.0;  // a device that the search comes to
  const ShotModel model(start.device, {record}, time_domain_coordinates(start, one), locked,
                        std::min(most_steps, stiffer * steps + 1.0));
  // The steps times what is followed in each.
  const auto states = static_cast<double>(model.states());
  const double cost = std::max(1.0, steps) * states * (static_cast<double>(start.free.size()) + 1.0 + states);
  const double affordable = std::max(static_cast<double>(shortest), most_cost / cost);
  constexpr std::size_t noise_terms = 24;
  const ShotSearch search(model, {encoder_step(record.position)}, noise_terms);
  // Of what takes long to play, the first part.
  constexpr double length = 5.0;  // s
  std::vector<Shot> shots = cut_into_shots(model.records(), start.device,
                                           std::min(length, 0.5 * affordable * record.sampling_period), shortest);
  const double share = affordable / static_cast<double>(record.force.size());
  const double kept = std::max(1.0, std::round(share * static_cast<double>(shots.size())));
  const bool is_cut = kept < static_cast<double>(shots.size());
  if (is_cut) shots.resize(static_cast<std::size_t>(kept));
  const bool is_of_a_part = is_cut && most_cost < cost_of_the_whole;
  constexpr double part = 0.1;
  constexpr std::size_t few = 3;
  const std::vector<Shot> short_shots =
      some_of(cut_into_shots(model.records(), start.device, part * length, shortest), 1, few);
  std::vector<SearchStart> starts;
  for (const FrictionStart& each : starting_frictions(start, one)) {
    starts.push_back({model.position_of(each.device), each.handicap});
  }
  const Follower follower{model, search, shots};
  auto found_best = best_from(follower, starts, short_shots);
  if (!found_best) return std::nullopt;
  const auto at = static_cast<Eigen::Index>(start.free.size()) - 1;
  auto friction = beside_linear(follower, *std::move(found_best), model.position_of(linear.parameters()), at);
  if (!friction || !(friction->gain() > as_much)) return std::nullopt;
  auto best = describe(follower, *friction, at, body.name, is_of_a_part);
  const auto is_decided = [&] {
    return asks_more == AsksMore::no || meaning_of(best->found, result.analysis) == Meaning::shows ||
           is_far_below(*best->found.friction.stiffness_beside, result.analysis);
  };
  if (!best) return std::nullopt;
  if (is_decided()) return best->found;
  MoreFriction more = more_friction(follower, *friction, at, *best, result.analysis);
  if (more.better) {  // the best was a side minimum
    auto better = describe(follower, *more.better, at, body.name, is_of_a_part);
    if (!better) return best->found;
    friction = std::move(more.better);
    best = std::move(better);
    if (is_decided()) return best->found;
    more = more_friction(follower, *friction, at, *best, result.analysis);
  }
  return more.far ? more.far : best->found;
}

/// Of the friction of the heaviest body that any recording shows, else of the next, that beside which the critical stiffness
/// is lowest; where none shows, of what the records leave open what changes the answer: more than the best is asked after until
/// something does.
std::optional<FrictionBeside> lowering_friction(const Identification& result, std::span<const Recording> recordings,
                                                const std::vector<std::string>& locked) {
  const auto ask = [&](const Body& body, const Recording& recording, double most_cost,
                       AsksMore asks_more) -> std::optional<FrictionBeside> {
    try {
      return friction_beside(result, body, locked, recording, most_cost, asks_more);
    } catch (const Error&) {  // no device has such numbers
      return std::nullopt;
    }
  };
  const auto rank = [&](const FrictionBeside& each) {
    return std::tuple(meaning_of(each, result.analysis) != Meaning::shows, !changes_the_answer(each, result.analysis),
                      *each.friction.stiffness_beside);
  };
  std::optional<FrictionBeside> lowest;
  for (const Body& body : moving_bodies(result.fit.device, locked)) {
    for (const Recording& each : recordings) {
      if (!can_be_asked(result, locked, each)) continue;
      const bool is_doubtful = lowest && changes_the_answer(*lowest, result.analysis);
      const AsksMore asks_more = is_doubtful ? AsksMore::no : AsksMore::yes;
      auto found = ask(body, each, cost_of_a_part, asks_more);
      if (found && found->is_of_a_part && meaning_of(*found, result.analysis) == Meaning::may_matter) {
        if (auto whole = ask(body, each, cost_of_the_whole, asks_more)) found = std::move(whole);
      }
      if (!found || meaning_of(*found, result.analysis) == Meaning::nothing) continue;
      if (!lowest || rank(*found) < rank(*lowest)) lowest = std::move(found);
    }
    if (lowest && meaning_of(*lowest, result.analysis) == Meaning::shows) break;
  }
  return lowest;
}

}  // namespace

void judge_friction_in_time(Identification& result, std::span<const Recording> recordings,
                            const IdentifyOptions& options) {
  if (!result.trust.sound() || !result.analysis.interval) return;
  if (options.scrutiny != IdentifyOptions::Scrutiny::thorough) return;
  if (options.response.output != OutputQuantity::position) return;
  const auto is_open = [&](const Recording& each) { return !can_be_asked(result, options.fit.locked, each); };
  if (!recordings.empty() && std::ranges::all_of(recordings, is_open)) {
    result.remarks.push_back(
        note({.code = FindingCode::friction_not_looked_for,
              .evidence = {{"samples", static_cast<double>(shortest)}, {"steps", static_cast<double>(most_steps)}}}));
    return;
  }
  const std::optional<FrictionBeside> lowering = lowering_friction(result, recordings, options.fit.locked);
  if (!lowering) return;
  const ShownFriction& friction = lowering->friction;
  const bool shows = meaning_of(*lowering, result.analysis) == Meaning::shows;
  const Motion motion = result.fit.device.parameters().motion;
  // Of one hardly told from none only what lies beside it is known.
  const bool has_size = shows || lowering->is_held || is_suspected(friction);
  Finding found{.code = shows ? FindingCode::friction_shown_in_time : FindingCode::friction_not_told_from_damping,
                .evidence = {{"stiffness", *friction.stiffness_beside}},
                .subjects = {{"body", friction.body}, {"unit", std::string(units_of(motion).stiffness)}},
                .key = fmt::format("body.{}.coulomb", friction.body),
                .effect = {{"critical_stiffness", *friction.stiffness_beside}}};
  if (has_size) {
    found.evidence.push_back({"force", friction.force});
    found.subjects.push_back({"force_unit", motion == Motion::rotary ? "N m" : "N"});
  }
  if (shows) result.friction = friction;
  if (changes_the_answer(*lowering, result.analysis)) {
    result.trust.doubt(found);
    result.remarks.push_back(warning(std::move(found)));
  } else {
    found.evidence.push_back({"within_from", result.analysis.interval->lower});
    result.remarks.push_back(note(std::move(found)));
  }
}

}  // namespace zwidth::internal
