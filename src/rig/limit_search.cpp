#include "zwidth/rig/limit_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "doubt_all.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/signal/dominant_oscillation.hpp"

namespace zwidth {
namespace {

constexpr double beyond_extrapolation = 1.01;
constexpr double least_step = 1.002;
constexpr double share_of_bracket = 0.4;    // by which a trial lies to one side of where zero is expected
constexpr double softest_share = 1e-3;      // of the start: nothing below is tried
constexpr double highest_share = 0.98;      // of Nyquist's frequency
constexpr double start_share = 0.5;         // of the predicted limit
constexpr double ceiling_share = 1.5;       // of the predicted limit
constexpr double least_swing_share = 0.01;  // of the swing at the end: what is smaller leaks from another oscillation
constexpr double same_frequency = 0.2;      // relative: growth rates of one oscillation
constexpr double sure_deviations = 3.0;     // of a growth rate; its windows overlap
constexpr double clearly_beyond = 1.5;      // of a growth rate's error: a wall that shows growth
constexpr double hop_cycles = 1.5;          // between windows of ring_down()
constexpr double far_below = 0.95;          // of a stiffness
constexpr double size_margin = 2.0;         // of the error by the size of the swing
constexpr double least_difference = 0.2;    // of two swings, relative
constexpr double most_difference = 1.0;     // the same: of one impulse and of half of it
constexpr double most_error = 0.02;         // relative: what a measured limit may be off by

bool swing_alike(const LimitTrial& low, const LimitTrial& high) {
  return low.ring && high.ring && std::abs(high.ring->frequency / low.ring->frequency - 1.0) <= same_frequency;
}

/// Where the line through two growth rates passes zero; absent where they are not of one oscillation that grows with K.
std::optional<double> zero_of_growth(const LimitTrial& low, const LimitTrial& high) {
  if (!swing_alike(low, high)) return std::nullopt;
  const double rise = high.ring->growth_rate - low.ring->growth_rate;
  if (!(rise > 0.0)) return std::nullopt;
  return low.stiffness - low.ring->growth_rate * (high.stiffness - low.stiffness) / rise;
}

/// How an oscillation's pole s + jw moves with the stiffness, 1/s per N/m or N m/rad.
struct PoleMotion {
  double growth = 0.0;
  double frequency = 0.0;  ///< size
};

PoleMotion motion_between(const LimitTrial& low, const LimitTrial& high) {
  const double apart = high.stiffness - low.stiffness;
  return {(high.ring->growth_rate - low.ring->growth_rate) / apart,
          std::abs(high.ring->frequency - low.ring->frequency) / apart};
}

/// At the limit, between two trials with a zero of growth. Where they are close, a growth rate that is misread makes the
/// rise look steep, and a steep rise the limit look sure: then that from a trial further below counts, if it is less.
PoleMotion motion_at_limit(const std::vector<LimitTrial>& trials, const LimitTrial& low, const LimitTrial& high) {
  PoleMotion motion = motion_between(low, high);
  const LimitTrial* below = nullptr;
  for (const LimitTrial& each : trials) {
    if (each.grows() || each.stiffness > far_below * low.stiffness || !swing_alike(each, high)) continue;
    if (below == nullptr || each.stiffness > below->stiffness) below = &each;
  }
  if (below == nullptr) return motion;
  const PoleMotion wide = motion_between(*below, high);
  if (wide.growth > 0.0) motion.growth = std::min(motion.growth, wide.growth);
  motion.frequency = wide.frequency;
  return motion;
}

/// Relative error of a stiffness that an encoder of this step makes at this swing.
///
/// To a swing A the encoder is a gain N(A): its describing function, for rounding to steps q, is about 1 -+ 0.5 (q/A)^1.5 at
/// the worst, and more where the middle of the swing is not that of a step (Gelb & Vander Velde, "Multiple-Input
/// Describing Functions and Nonlinear System Design", 1968, appendix B). Three times that is allowed for; the wall that
/// is felt is N K.
double encoder_error(double step, double swing) { return 1.5 * std::pow(step / swing, 1.5); }

/// Relative error of a limit by the angle that the rounding of n samples per cycle turns the position's first harmonic:
/// q/(A sqrt(6 n)) in the mean over where the samples lie, where they lie alike in each cycle. A gain of the wall that
/// turns by an angle e moves the pole by K |ds/dK + j dw/dK| e, which a change of K makes good by ds/dK.
double turning_error(double step, double swing, double samples_per_cycle, const PoleMotion& motion) {
  return step / swing / std::sqrt(6.0 * samples_per_cycle) * std::hypot(motion.growth, motion.frequency) /
         motion.growth;
}

/// By how much a growth rate may be off, 1/s: as of LimitSearch.
double growth_error(const RingDown& ring, double step, double period) {
  const double samples_per_cycle = 2.0 * std::numbers::pi / (ring.frequency * period);
  const double span = hop_cycles * static_cast<double>(ring.windows - 1) * 2.0 * std::numbers::pi / ring.frequency;
  const double swing = ring.amplitude * std::exp(-0.5 * ring.growth_rate * span);  // in the middle
  return sure_deviations * ring.growth_deviation +
         step / swing / std::sqrt(6.0 * samples_per_cycle) * 0.5 * ring.frequency;
}

/// The wall that a trial felt at the stiffest, where its oscillation surely grew.
std::optional<double> sure_to_grow(const LimitTrial& trial, double step) {
  if (!trial.surely_grows()) return std::nullopt;
  if (step == 0.0) return trial.stiffness;
  const double swing = trial.ring ? trial.ring->amplitude : 0.0;
  return trial.stiffness * (1.0 + std::min(encoder_error(step, swing), 1.0));
}

/// By how much the limit of another size of swing may differ, from the growth after an impulse and after half of it.
///
/// Dry friction takes c/A from the growth rate of a swing A, c constant, so that of two swings
///
///     c/A = (s - s') / (A/A' - 1)
///
/// and the slope of the growth rate makes a stiffness of it. Twice that is allowed for: the swings fall while they are
/// read, and the slope is that of trials with their friction.
double size_error(const RingDown& whole, const RingDown& smaller, const PoleMotion& motion) {
  // At their ends: one that decays fast seems to have been smaller than the impulse made it.
  const double larger_by =
      std::clamp(std::abs(whole.amplitude / smaller.amplitude - 1.0), least_difference, most_difference);
  return size_margin * std::abs(whole.growth_rate - smaller.growth_rate) / larger_by / motion.growth;
}

}  // namespace

std::optional<RingDown> least_damped_oscillation(std::span<const double> position, double period,
                                                 std::span<const double> frequencies, double floor) {
  std::vector<double> candidates(frequencies.begin(), frequencies.end());
  if (const auto strongest = dominant_oscillation(position, period)) candidates.push_back(strongest->frequency);
  double mean = 0.0;
  double squares = 0.0;
  const auto end = position.last(position.size() / 4);
  for (const double x : end) mean += x / static_cast<double>(end.size());
  for (const double x : end) squares += (x - mean) * (x - mean) / static_cast<double>(end.size());
  std::optional<RingDown> least;
  for (const double frequency : candidates) {
    if (!(frequency > 0.0 && frequency * period < highest_share * std::numbers::pi)) continue;
    const auto ring = ring_down(position, period, frequency, floor);
    if (!ring || ring->amplitude < least_swing_share * std::sqrt(squares)) continue;
    if (!least || ring->growth_rate > least->growth_rate) least = ring;
  }
  return least;
}

std::optional<OptionProblem> find_problem(const LimitSearchOptions& options) {
  using enum ProblemCode;
  const auto problem = [](const char* member, ProblemCode code, double value, const char* measure) {
    return option_problem(
        member, {.code = code, .evidence = {{"value", value}, {"bound", 0.0}}, .subjects = {{"measure", measure}}});
  };
  const auto beyond = [](const char* member, ProblemCode code, double value, double most) {
    return option_problem(member, {.code = code, .evidence = {{"value", value}, {"most", most}}});
  };
  if (!(std::isfinite(options.start) && options.start > 0.0)) {
    return problem("start", not_above, options.start, "stiffness");
  }
  if (!(std::isfinite(options.ceiling) && options.ceiling >= options.start)) {
    return problem("ceiling", ceiling_below_start, options.ceiling, "stiffness");
  }
  if (!(options.step > 1.0 && options.step <= 2.0)) return beyond("step", no_growth_factor, options.step, 2.0);
  if (!(options.bracket > 0.0 && options.bracket <= 0.5)) {
    return beyond("bracket", no_share_between, options.bracket, 0.5);
  }
  if (!(std::isfinite(options.floor) && options.floor >= 0.0)) {
    return problem("floor", below_bound, options.floor, "distance");
  }
  return std::nullopt;
}

std::optional<LimitSearchOptions> limit_search_options(const Device& device, const CriticalStiffness& predicted,
                                                       std::optional<double> any_user) {
  if (predicted.status != StiffnessStatus::finite) return std::nullopt;
  LimitSearchOptions options;
  const double least = any_user && *any_user > 0.0 ? std::min(*any_user, predicted.stiffness) : predicted.stiffness;
  options.start = start_share * least;
  options.ceiling = ceiling_share * predicted.stiffness;
  options.frequencies.push_back(predicted.limit->frequency);
  for (const Crossover& each : predicted.crossovers) options.frequencies.push_back(each.frequency);
  options.floor = device.parameters().sensor.resolution;
  return options;
}

LimitSearch::LimitSearch(LimitSearchOptions options) : options_(std::move(options)) {
  require_valid(find_problem(options_));
}

const LimitTrial* LimitSearch::surely_unstable() const {
  const LimitTrial* softest = nullptr;
  for (const LimitTrial& trial : trials_) {
    if (trial.surely_grows() && (softest == nullptr || trial.stiffness < softest->stiffness)) softest = &trial;
  }
  return softest;
}

const LimitTrial* LimitSearch::surely_stable() const {
  const LimitTrial* above = surely_unstable();
  const LimitTrial* stiffest = nullptr;
  for (const LimitTrial& trial : trials_) {
    if (!trial.surely_decays() || (above != nullptr && trial.stiffness > above->stiffness)) continue;
    if (stiffest == nullptr || trial.stiffness > stiffest->stiffness) stiffest = &trial;
  }
  return stiffest;
}

const LimitTrial* LimitSearch::unstable() const {
  const LimitTrial* below = surely_stable();
  const LimitTrial* softest = nullptr;
  for (const LimitTrial& trial : trials_) {
    if (!trial.grows() || (below != nullptr && trial.stiffness < below->stiffness)) continue;
    if (softest == nullptr || trial.stiffness < softest->stiffness) softest = &trial;
  }
  return softest;
}

const LimitTrial* LimitSearch::stable() const {
  const LimitTrial* above = unstable();
  const LimitTrial* stiffest = nullptr;
  for (const LimitTrial& trial : trials_) {
    if (trial.grows() || (above != nullptr && trial.stiffness > above->stiffness)) continue;
    if (stiffest == nullptr || trial.stiffness > stiffest->stiffness) stiffest = &trial;
  }
  return stiffest;
}

double LimitSearch::stiffer() const {
  const LimitTrial& last = trials_.back();
  double stiffness = options_.step * last.stiffness;
  if (trials_.size() >= 2) {
    const LimitTrial& before = trials_[trials_.size() - 2];
    if (const auto zero = zero_of_growth(before, last)) {
      const double shown = *zero + clearly_beyond * last.growth_error / motion_between(before, last).growth;
      stiffness = std::min(stiffness, std::max({beyond_extrapolation * *zero, shown, least_step * last.stiffness}));
    }
  }
  return std::min(stiffness, options_.ceiling);
}

std::optional<double> LimitSearch::next() const {
  if (trials_.empty()) return options_.start;
  if (trials_.size() >= most_trials) return std::nullopt;
  const bool has_reached_ceiling =
      std::ranges::any_of(trials_, [&](const LimitTrial& each) { return each.stiffness >= options_.ceiling; });
  if (surely_unstable() == nullptr && !has_reached_ceiling) return stiffer();
  const LimitTrial* low = stable();
  const LimitTrial* high = unstable();
  if (high == nullptr) return std::nullopt;
  if (low == nullptr) {
    const double softer = 0.5 * high->stiffness;
    return softer < softest_share * options_.start ? std::nullopt : std::optional(softer);
  }
  const double width = high->stiffness - low->stiffness;
  const double wanted = options_.bracket * high->stiffness;
  if (width <= wanted) return std::nullopt;
  const double middle = 0.5 * (low->stiffness + high->stiffness);
  const auto zero = zero_of_growth(*low, *high);
  if (!zero) return middle;
  const bool is_far_above = high->stiffness - *zero > *zero - low->stiffness;
  const double next = *zero + (is_far_above ? 1.0 : -1.0) * share_of_bracket * wanted;
  return next > low->stiffness && next < high->stiffness ? next : middle;
}

void LimitSearch::add(double stiffness, std::span<const double> position, double sampling_period, bool stopped,
                      bool cut) {
  LimitTrial& trial = trials_.emplace_back();
  trial.stiffness = stiffness;
  trial.ring = least_damped_oscillation(position, sampling_period, options_.frequencies, options_.floor);
  trial.stopped = stopped;
  trial.cut = cut;
  if (trial.ring) trial.growth_error = growth_error(*trial.ring, options_.floor, sampling_period);
  period_ = sampling_period;
}

std::optional<double> LimitSearch::next_smaller() const {
  const LimitTrial* low = stable();
  const LimitTrial* high = unstable();
  if (low == nullptr || high == nullptr || low->cut || high->cut || !zero_of_growth(*low, *high)) return std::nullopt;
  return low->stiffness;
}

void LimitSearch::add_smaller(std::span<const double> position, double sampling_period) {
  has_smaller_ = true;
  smaller_ = least_damped_oscillation(position, sampling_period, options_.frequencies, options_.floor);
}

void LimitSearch::doubt_untold(const Units& units, LimitMeasurement& result) const {
  const LimitTrial* stable = surely_stable();
  // Where none surely decays, nothing is told of any wall below the limit.
  const double below_which = stable != nullptr ? stable->stiffness : result.stiffness.value_or(0.0);
  double softest = 0.0;
  double stiffest = 0.0;
  for (const LimitTrial& trial : trials_) {
    const bool is_told = !trial.ring || trial.surely_grows() || trial.surely_decays();
    if (is_told || trial.stiffness > below_which) continue;
    softest = softest == 0.0 ? trial.stiffness : std::min(softest, trial.stiffness);
    stiffest = std::max(stiffest, trial.stiffness);
  }
  if (softest == 0.0) return;
  result.trust.doubt({.code = FindingCode::growth_not_told,
                      .evidence = {{"softest", softest, units.stiffness}, {"stiffest", stiffest, units.stiffness}}});
  if (!result.interval) return;
  double below = 0.0;
  for (const LimitTrial& trial : trials_) {
    if (trial.surely_decays() && trial.stiffness < softest) below = std::max(below, trial.stiffness);
  }
  result.interval->lower = std::min(result.interval->lower, below);
}

LimitMeasurement LimitSearch::measurement(const Device& device) const {
  LimitMeasurement result;
  result.trials = trials_;
  const Units units = units_of(device.parameters().motion);
  // What was measured stands whatever the file's numbers are; that they are doubtful is said beside it.
  internal::doubt_all(trust_of(device), result.trust);
  const LimitTrial* low = stable();
  const LimitTrial* high = unstable();
  if ((low != nullptr && low->cut) || (high != nullptr && high->cut)) {
    result.trust.refuse({.code = FindingCode::force_cut_off});
    return result;
  }
  if (low != nullptr) result.lower = low->stiffness;
  if (high != nullptr) result.upper = high->stiffness;
  if (trials_.empty()) {
    result.trust.refuse({.code = FindingCode::no_trial_ended});
    return result;
  }
  if (high == nullptr) {
    result.trust.refuse(
        {.code = FindingCode::no_oscillation_grew, .evidence = {{"stiffness", result.lower, units.stiffness}}});
    return result;
  }
  if (low == nullptr) {
    result.at_most = sure_to_grow(*high, options_.floor);
    result.trust.refuse(
        {.code = FindingCode::every_wall_oscillates, .evidence = {{"stiffness", result.upper, units.stiffness}}});
    return result;
  }
  const auto zero = zero_of_growth(*low, *high);
  result.stiffness = zero.value_or(0.5 * (low->stiffness + high->stiffness));
  if (zero) {
    const double share = (*zero - low->stiffness) / (high->stiffness - low->stiffness);
    result.frequency = low->ring->frequency + share * (high->ring->frequency - low->ring->frequency);
  } else {
    if (high->ring) result.frequency = high->ring->frequency;
    result.trust.doubt({.code = FindingCode::growth_not_bracketed});
  }
  const double swing = low->ring && high->ring ? std::min(low->ring->amplitude, high->ring->amplitude) : 0.0;
  const double of_encoder = options_.floor > 0.0 ? std::min(encoder_error(options_.floor, swing), 1.0) : 0.0;
  double of_growth = 0.0;  // N/m or N m/rad
  double of_size = 0.0;    // the same
  double of_step = of_encoder;
  if (zero) {
    const PoleMotion motion = motion_at_limit(trials_, *low, *high);
    of_growth = sure_deviations * std::max(low->ring->growth_deviation, high->ring->growth_deviation) / motion.growth;
    const double samples_per_cycle = 2.0 * std::numbers::pi / (result.frequency * period_);
    const double of_turning = turning_error(options_.floor, swing, samples_per_cycle, motion);
    const double widening = std::min(of_encoder + of_turning, 1.0);
    if (smaller_) {
      of_size = size_error(*low->ring, *smaller_, motion);
      of_step += of_turning + turning_error(options_.floor, smaller_->amplitude, samples_per_cycle, motion);
    }
    result.interval = Interval{
        .lower = std::max(0.0, std::min(low->stiffness, *result.stiffness - of_growth - of_size) * (1.0 - widening)),
        .upper = std::max(high->stiffness, *result.stiffness + of_growth) * (1.0 + widening)};
  }
  result.at_most = result.interval ? std::optional(result.interval->upper) : sure_to_grow(*high, options_.floor);
  if (of_encoder > most_error) {
    result.trust.doubt({.code = FindingCode::encoder_coarse_for_swing,
                        .evidence = {{"resolution", options_.floor, units.length},
                                     {"swing", swing, units.length},
                                     {"error", of_encoder},
                                     {"threshold", most_error}}});
  } else if (of_growth > most_error * *result.stiffness) {
    result.trust.doubt({.code = FindingCode::growth_not_known,
                        .evidence = {{"error", of_growth / *result.stiffness}, {"threshold", most_error}}});
  }
  if (zero && !has_smaller_) {
    result.trust.doubt({.code = FindingCode::no_smaller_impulse});
  } else if (zero && !smaller_) {
    result.trust.doubt({.code = FindingCode::smaller_impulse_not_read});
    if (of_step < most_error) result.interval.reset();
  } else if (of_size > (most_error + std::min(of_step, most_error)) * *result.stiffness) {
    const bool is_faster = smaller_->growth_rate < low->ring->growth_rate;
    result.trust.doubt(
        {.code = is_faster ? FindingCode::smaller_swing_decays_faster : FindingCode::smaller_swing_decays_less,
         .evidence = {{"error", std::min(1.0, of_size / *result.stiffness)},
                      {"threshold", most_error + std::min(of_step, most_error)}}});
    if (of_step < most_error) result.interval.reset();  // else the encoder makes it, for which it is wide enough
  }
  doubt_untold(units, result);
  const double width = (high->stiffness - low->stiffness) / high->stiffness;
  if (width > options_.bracket) {
    result.trust.doubt({.code = FindingCode::bracket_wide,
                        .evidence = {{"lower", low->stiffness, units.stiffness},
                                     {"upper", high->stiffness, units.stiffness},
                                     {"width", width},
                                     {"threshold", options_.bracket}}});
  }
  const auto has_friction = [](const Body& body) { return body.coulomb > 0.0; };
  if (std::ranges::any_of(device.bodies(), has_friction)) {
    result.trust.doubt({.code = FindingCode::friction_holds_swing});
  }
  return result;
}

}  // namespace zwidth
