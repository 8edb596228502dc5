#include "zwidth/identification/time_domain.hpp"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/disturbed_motion.hpp"
#include "identification/response/encoder_step.hpp"
#include "identification/feedback_test.hpp"
#include "identification/fit_judgement.hpp"
#include "identification/lateness.hpp"
#include "identification/shot_covariance.hpp"
#include "identification/shot_device.hpp"
#include "identification/shot_fit.hpp"
#include "identification/shot_search.hpp"
#include "identification/time_domain_judgement.hpp"
#include "identification/time_domain_start.hpp"
#include "require_valid.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t least_samples = 512;

void check(std::span<const Recording> recordings, const Device& structure, const TimeDomainOptions& options) {
  require_valid(find_problem(options));
  if (recordings.empty()) throw Error(ErrorCode::invalid_argument, "there is no recording; must be at least one");
  if (!structure.has_bodies()) {
    throw Error(ErrorCode::invalid_argument, "the structure is a transfer function; it must be a device of bodies");
  }
  for (const Recording& each : recordings) {
    if (each.channels.size() != 2) {
      throw Error(ErrorCode::invalid_argument, fmt::format("{} has {} channels; must be two: force and position",
                                                           each.source, each.channels.size()));
    }
    const std::size_t size = each.channels[0].samples.size();
    const std::size_t order = options.noise_order;
    if (size < std::max(least_samples, 8 * order) || each.channels[1].samples.size() != size) {
      throw Error(ErrorCode::invalid_argument, fmt::format("{} has {} samples; must be at least {}, of both channels",
                                                           each.source, size, std::max(least_samples, 8 * order)));
    }
  }
}

/// Lets go what is held at its bound although the data pull it away from there; whether there is any.
bool release(ShotFit& fit, const ShotCovariance& known) {
  bool any = false;
  for (std::size_t k = 0; k < fit.held.size(); ++k) {
    constexpr double significant = 3.0;
    if (!fit.held[k] || !(known.pull(static_cast<Eigen::Index>(k)) > significant)) continue;
    fit.held[k] = false;
    any = true;
  }
  return any;
}

/// A lag that is short beside the sampling period is hardly another thing than a delay: held at 0 until the data pull it
/// away from there.
void take_short_lag_for_delay(const ShotModel& model, ShotFit& fit) {
  const auto place = [&](const char* key) {
    const auto& all = model.coordinates();
    return std::ranges::find(all, key, &Coordinate::key) - all.begin();
  };
  const auto count = static_cast<std::ptrdiff_t>(model.coordinates().size());
  const auto lag = place("actuator.time_constant");
  const auto delay = place("loop.delay");
  constexpr double brief = 0.15;  // sampling periods, the unit of both
  if (lag == count || delay == count || fit.x(lag) > brief) return;
  fit.x(delay) += fit.x(lag);
  fit.x(lag) = 0.0;
  fit.held[static_cast<std::size_t>(lag)] = true;
}

bool stands_still(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const Eigen::MatrixXd& covariance) {
  constexpr double notable = 0.1;  // of a standard deviation
  return ((after - before).array().abs() <= notable * covariance.diagonal().array().sqrt() ||
          covariance.diagonal().array() == 0.0)
      .all();
}

/// A common factor of all masses, dampings, stiffnesses and frictions, which is the force's scale, is never known better.
void add_open_scale(const ShotModel& model, const ShotFit& fit, ShotCovariance& known) {
  constexpr double open_scale = 1e-3;  // one standard deviation
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(fit.x.size());
  for (std::size_t i = 0; i < model.coordinates().size(); ++i) {
    const Coordinate& coordinate = model.coordinates()[i];
    const bool is_time = coordinate.key == "loop.delay" || coordinate.key == "actuator.time_constant";
    if (is_time || fit.held[i] || !known.known.shows(i)) continue;
    const auto at = static_cast<Eigen::Index>(i);
    scale(at) = coordinate.kind == Coordinate::Kind::logarithmic ? 1.0 : fit.x(at);
  }
  known.covariance += open_scale * open_scale * scale * scale.transpose();
}

/// A fit under the noise of its own residuals.
struct Round {
  FittedShots fitted;
  ShotCovariance known;
  double badness = 0.0;
  bool is_at_rest = false;
};

std::optional<Round> next_round(const ShotSearch& search, const ShotModel& model, const std::vector<Shot>& shots,
                                const ShotFit& start, const Eigen::VectorXd& towards) {
  auto fitted =
      search.with_noise(start, shots, towards, {.most_iterations = 12, .tolerance = 2e-6, .holds_bounds = true});
  if (!fitted) return std::nullopt;
  const auto slopes = shot_slopes(model, shots, fitted->noise, fitted->fit.x, fitted->fit.states);
  if (!slopes) return std::nullopt;
  ShotCovariance known = shot_covariance(*slopes, fitted->fit.held);
  add_open_scale(model, fitted->fit, known);
  const double badness = search.badness(*fitted, shots);
  return Round{*std::move(fitted), std::move(known), badness};
}

/// Whether the slopes promise a better fit where the search ended: as the instants of sticking and slipping change, the
/// misfit has kinks, and side minima between them.
bool asks_for_more(const Round& round) {
  constexpr double notable = 0.2;  // of a standard deviation
  return (round.known.step.array().abs() > notable * round.known.covariance.diagonal().array().sqrt()).any();
}

/// Where the slopes point to, past the kinks.
ShotFit beyond(const ShotModel& model, const Round& round) {
  ShotFit fit = round.fitted.fit;
  fit.x = moved(model, fit.x, round.known.step, round.known.covariance);
  return fit;
}

/// What the search left open counts among what is not known.
void widen_by_step(ShotCovariance& known) { known.covariance += known.step * known.step.transpose(); }

void describe_motions(TimeDomainIdentification& result, std::span<const Recording> recordings, const ShotModel& model,
                      const std::vector<Shot>& shots, const FittedShots& fitted, const Eigen::MatrixXd& covariance) {
  const auto residuals = shot_residuals(model, shots, fitted.fit.x, fitted.fit.states);
  const std::vector<double> feedback = residuals ? feedback_evidence(model, shots, fitted.noise, *residuals)
                                                 : std::vector<double>(recordings.size(), 0.0);
  const bool is_free =
      std::ranges::all_of(result.device.bodies(), [](const Body& body) { return body.stiffness == 0.0; });
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const auto bias = static_cast<Eigen::Index>(model.coordinates().size() + r);
    FittedMotion motion{.source = recordings[r].source,
                        .sampling_period = recordings[r].sampling_period,
                        .constant_force = fitted.fit.x(bias) * model.force_unit(r),
                        .constant_force_deviation = std::sqrt(covariance(bias, bias)) * model.force_unit(r),
                        .noise = fitted.noise[r].deviation,
                        .feedback = feedback[r]};
    motion.recorded = recordings[r].channels[1].samples;
    motion.residuals.assign(motion.recorded.size(), 0.0);
    for (std::size_t i = 0; residuals && i < shots.size(); ++i) {
      if (shots[i].record != r) continue;
      // Nothing holds a free device to a place: under noise that drifts it is not known where a shot is.
      const double place = is_free ? (*residuals)[i].mean() : 0.0;
      for (std::size_t k = 0; k < shots[i].count; ++k) {
        motion.residuals[shots[i].first + k] = place - (*residuals)[i](static_cast<Eigen::Index>(k));
      }
    }
    result.motions.push_back(std::move(motion));
  }
}

}  // namespace

std::optional<OptionProblem> find_problem(const TimeDomainOptions& options) {
  if (!(std::isfinite(options.segment) && options.segment > 0.0)) {
    return OptionProblem{"segment", fmt::format("is {} s", options.segment), "must be finite and > 0"};
  }
  constexpr std::size_t most_order = 200;
  if (options.noise_order > most_order) {
    return OptionProblem{"noise_order", fmt::format("is {}", options.noise_order),
                         fmt::format("must be at most {}", most_order)};
  }
  if (options.free.size() > max_free_parameters) {
    return OptionProblem{"free", fmt::format("has {} keys", options.free.size()),
                         fmt::format("must be at most {}", max_free_parameters)};
  }
  return std::nullopt;
}

TimeDomainIdentification identify_in_time(std::span<const Recording> recordings, const Device& structure,
                                          const TimeDomainOptions& options, const Progress& progress) {
  check(recordings, structure, options);
  const auto done = [&](double share) {
    if (progress) progress(share);
  };
  const TimeDomainStart start = time_domain_start(recordings, structure, options);
  done(0.2);
  std::vector<MotionRecord> records;
  std::vector<double> steps;
  for (const Recording& each : recordings) {
    records.push_back({each.channels[0].samples, each.channels[1].samples, each.sampling_period});
    steps.push_back(encoder_step(records.back().position));
  }
  const ShotModel model(start.device, records, time_domain_coordinates(start, recordings), options.locked);
  const ShotSearch search(model, steps, options.noise_order);
  const std::size_t least = std::max<std::size_t>(256, 8 * options.noise_order);

  // Which friction to start from: short shots, a few of them.
  constexpr double part = 0.1;
  constexpr std::size_t few = 3;
  const std::vector<Shot> short_shots =
      some_of(cut_into_shots(records, start.device, part * options.segment, least), records.size(), few);
  std::vector<SearchStart> starts;
  for (const FrictionStart& each : starting_frictions(start, recordings)) {
    starts.push_back({model.position_of(each.device), each.handicap});
  }
  const std::optional<FittedShots> best = least_bad(search.from_each(starts, short_shots));
  if (!best) {
    throw Error(
        ErrorCode::did_not_converge,
        "no device near the fit of the response can be played through the record; see what that fit says; excite "
        "by noise, a sweep or a multisine, and check the structure");
  }
  done(0.5);

  const std::vector<Shot> shots = cut_into_shots(records, start.device, options.segment, least);
  const Eigen::VectorXd towards = best->fit.x;
  // The noise of a few short shots is not yet that of the whole: what a longer search under it finds, the next undoes.
  std::optional<ShotFit> whole;
  if (auto begun = search.with_fitted_states(towards, shots, best->noise, ShotSearch::Constants::fitted)) {
    whole = fit_shots(model, shots, best->noise, *std::move(begun), towards, {.most_iterations = 6, .tolerance = 5e-4});
  }
  std::optional<Round> found;  // the best
  constexpr int most_rounds = 5;
  constexpr int most_rounds_downhill = 20;
  constexpr double steep = 50.0;  // of the log-likelihood, in a round: along a valley of kinks
  constexpr int most_leaps = 2;
  constexpr double notable = 2.0;  // of the log-likelihood
  int leaps = 0;
  double fall = 0.0;
  bool is_at_rest = false;
  if (whole) take_short_lag_for_delay(model, *whole);
  for (int round = 0; whole && (round < most_rounds + leaps || (fall > steep && round < most_rounds_downhill));
       ++round) {
    if (is_at_rest) {
      const bool leaps_on = asks_for_more(*found);
      if (leaps_on) whole = beyond(model, *found);
      const double gain = search.restart_states(*whole, shots, found->fitted.noise);
      const bool rests = !leaps_on && gain < notable;
      if (rests) fall = 0.0;  // whatever led there
      if (rests || leaps++ == most_leaps) break;
    }
    const Eigen::VectorXd before = whole->x;
    std::optional<Round> now = next_round(search, model, shots, *whole, towards);
    if (!now && (leaps > 0 || round >= most_rounds)) break;
    if (!now) found.reset();
    if (!now) break;
    done(0.5 + 0.1 * (std::min(round, most_rounds - 1) + 1));
    whole = now->fitted.fit;
    is_at_rest = !release(*whole, now->known) && stands_still(before, whole->x, now->known.covariance);
    now->is_at_rest = is_at_rest;
    fall = found ? found->badness - now->badness : 0.0;
    const double allowed = found && is_at_rest && !found->is_at_rest ? notable : 0.0;
    if (!found || now->badness < found->badness + allowed) found = std::move(now);
  }
  if (!found) {
    throw Error(
        ErrorCode::did_not_converge,
        "the fit lost itself where no device can be played; check the structure, free fewer parameters, or start from "
        "values that are nearly right");
  }
  widen_by_step(found->known);
  if (const auto slopes =
          shot_slopes(model, shots, found->fitted.noise, found->fitted.fit.x, found->fitted.fit.states)) {
    widen(found->known.covariance,
          scatter_under_disturbance({model, shots, found->fitted.noise, found->fitted.fit, *slopes,
                                     found->known.known.estimated, options.locked, start.lowest, start.highest}));
  }

  TimeDomainIdentification result{.device = structure};
  result.lowest = start.lowest;
  result.highest = start.highest;
  result.settled = (found->fitted.fit.settled || found->is_at_rest) && fall <= steep;
  result.remarks = start.remarks;
  describe_parameters(result, model, found->fitted.fit, found->known);
  describe_motions(result, recordings, model, shots, found->fitted, found->known.covariance);
  std::optional<double> other;
  std::optional<Finding> open_delay;
  if (start.may_be_late) {  // or friction is there, as the fit in time tells
    TimeDomainOptions wider = options;
    wider.free = start.free;
    wider.free.emplace_back(delay_key);
    const TimeDomainIdentification freed = identify_in_time(recordings, structure, wider);
    other = other_delay(*std::ranges::find(freed.estimates, delay_key, &ParameterEstimate::key), structure.loop());
    if (other) {
      const double beyond = *other - structure.loop().delay;
      result.device = with_open_delay(result.device, beyond * beyond);
    } else if (assumes_delay(structure, options.structure_values, options.loop_delay)) {
      open_delay = doubt_of_open_delay(freed.device, result.device);
    }
  }
  const FittedDevice fitted{model, shots, found->fitted, found->known};
  JudgedTimeFit judged{recordings, structure, options, shots, start.is_turned, other, open_delay, start.linear};
  tbb::parallel_invoke(
      [&] { judged.disagreement = doubt_of_agreement(devices_of_recordings(fitted, recordings), result.device); },
      [&] { judged.contradicted = contradicted_numbers(fitted, structure, recordings, options.locked, start.lowest); },
      [&] { judged.weak_forces = find_weak_forces(fitted, options.locked, start.lowest, start.highest); });
  judge_in_time(result, judged);
  done(1.0);
  return result;
}

}  // namespace zwidth
