#include "rig/rig_actions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "rig/action_steps.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/rig/wall_verdict.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::rig {
namespace {

constexpr double swing = 1e-3;        // m or rad, of an impulse or a relay at the predicted limit
constexpr double swing_steps = 20.0;  // of the encoder, at least
constexpr double share_of_force = 1.0 / 3.0;
constexpr double above_friction = 3.0;
constexpr double dwell_cycles = 40.0;  // of it, after each impulse
constexpr double band_below = 5.0;     // of the limiting crossover
// A mode that may oscillate is within the band. A rigid body with friction needs more: to 2.5 times its crossover alone, the record of
// the capstan paddle gave half more than its limit.
constexpr double band_above = 8.0;
constexpr double band_above_highest = 2.5;  // of all crossovers
constexpr double highest_of_nyquist = 0.8;
constexpr double cycles_of_lowest = 8.0;  // in each period of the multisine
constexpr std::size_t measured_periods = 8;
constexpr std::size_t transient_periods = 4;  // at most: those in which it dies out are skipped
constexpr double shortest_dwell = 0.5;        // s
constexpr int holds_before_smaller = 3;       // and one before each impulse

/// Half a period of a sine at the frequency of the limit.
std::vector<double> impulse_at(double frequency, double force, double period) {
  const auto length = static_cast<std::size_t>(std::max(1.0, std::round(std::numbers::pi / (frequency * period))));
  std::vector<double> samples(length);
  for (std::size_t k = 0; k < length; ++k) {
    samples[k] = force * std::sin(std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(length));
  }
  return samples;
}

ControllerOptions wall_of(const Device& device, double stiffness) {
  ControllerOptions controller = wall_controller(device.parameters().wall);
  controller.stiffness = stiffness;
  return controller;
}

/// What the host runs of a wall: all of it, or the spring.
ControllerOptions on_host(ControllerOptions controller, bool damper_on_drive) {
  if (damper_on_drive) controller.damping = controller.velocity_filter_hz = 0.0;
  return controller;
}

/// What predicts a wall of two loops knows no drive's estimator.
void doubt_estimator(const Driver& driver, Trust& trust) {
  if (driver.facts().estimates_velocity) trust.doubt({.code = FindingCode::damper_estimator_not_modelled});
}

/// With any passive user, of one rate; nothing where nobody can hold it. That of two rates stands among the holding limits.
std::optional<AbsoluteStabilityLimit> any_user_limit(const Device& device) {
  if (!device.has_bodies() || device.bodies().size() > most_bodies_for_absolute_stability) return std::nullopt;
  if (has_damper_loop(device.loop())) return std::nullopt;
  return absolute_stability_limit(device, virtual_damper(device));
}

std::optional<OptionProblem> find_place_problem(bool on_drive, double damping, ControllerOptions::Contact contact,
                                                const Device& device) {
  using enum ProblemCode;
  const Loop& loop = device.loop();
  if (!has_damper_loop(loop)) {
    if (!on_drive) return std::nullopt;
    return option_problem("damper_on_drive", {.code = no_damper_loop});
  }
  if (!on_drive) return option_problem("damper_on_drive", {.code = damper_on_drive_not_asked});
  const double period = damper_timing(loop).sampling_period;
  if (!(period < loop.sampling_period)) {
    return option_problem(
        "loop.damper.sampling_period",
        {.code = damper_not_faster, .evidence = {{"value", period}, {"bound", loop.sampling_period}}});
  }
  if (!(damping > 0.0)) return option_problem("wall.damping", {.code = no_damping_for_drive});
  if (contact == ControllerOptions::Contact::unilateral) {
    return option_problem("controller.contact", {.code = contact_beside_drive});
  }
  return std::nullopt;
}

/// The device with the wall that runs as its own.
Device rendering(const Device& device, const ControllerOptions& controller) {
  DeviceParameters parameters = device.parameters();
  parameters.wall = {controller.stiffness, controller.damping, controller.velocity_filter_hz, controller.filters};
  return Device(std::move(parameters));
}

/// Limits and verdict with nobody and with the file's user: who holds the rig is not known, and a person lets go.
void predict(const Device& device, RigWall& wall) {
  const Device rendered = rendering(device, wall.controller);
  const Analysis analysis = analyze(rendered, {.critical_damping = false, .draws = 0});
  wall.limits = analysis.limits;
  wall.trust.inherit(
      analyze(rendered, limit_and_wall_only()).trust);  // not that of a limit for users who are not there
  if (analysis.trust.refused() || (wall.controller.stiffness == 0.0 && wall.controller.damping == 0.0)) return;
  wall.stable_for = analysis.wall_stable_for;
  wall.predicted_stable = stability_of(*wall.stable_for) != WallStability::unstable;
}

/// Where the device that nobody holds may oscillate, beside where the file's user makes it.
void add_frequencies(const Device& device, std::vector<double>& frequencies) {
  if (!device_has_user(device)) return;
  for (const Crossover& each : critical_stiffness(device_without_user(device)).crossovers) {
    frequencies.push_back(each.frequency);
  }
}

/// Hz: where the device may oscillate with the file's user or with nobody. A crossover at Nyquist, which nearly every loop has, no
/// record shows.
double highest_crossover(const Device& device, const CriticalStiffness& predicted) {
  constexpr double rounding = 1e-6;
  std::vector<double> frequencies{frequency_of(predicted)};
  for (const Crossover& each : predicted.crossovers) frequencies.push_back(each.frequency);
  add_frequencies(device, frequencies);
  const double nyquist = std::numbers::pi / device.loop().sampling_period;
  std::erase_if(frequencies, [&](double each) { return each > (1.0 - rounding) * nyquist; });
  return hertz(frequencies.empty() ? nyquist : *std::ranges::max_element(frequencies));
}

/// What was identified on a simulated device is trusted no more than its file, and the file that it makes says so.
void inherit(const Trust& trust, Identification& identified) {
  if (trust.sound()) return;
  identified.trust.inherit(trust);
  identified.analysis.trust.inherit(trust);
  DeviceParameters parameters = identified.fit.device.parameters();
  if (!parameters.uncertainty) parameters.uncertainty.emplace();
  Trust of_file = trust_of(identified.fit.device);
  of_file.inherit(trust);
  parameters.uncertainty->verdict = of_file.verdict;
  parameters.uncertainty->warning.clear();
  parameters.uncertainty->reasons = of_file.reasons;
  identified.fit.device = Device(std::move(parameters));
}

/// The limit with any passive user is that which stands beside, computed once; of two rates it is computed here.
HoldingLimits limits_beside(const Device& device, const RigLimit& limit) {
  const bool of_two_rates = has_damper_loop(device.loop());
  HoldingLimits limits = holding_limits(device, {.any_user = of_two_rates, .critical_damping = false});
  if (!limit.any_user) return limits;
  HolderLimit& any_user = limits.any_user.emplace();
  any_user.critical_stiffness = limit.any_user->stiffness;
  if (limit.any_user->stiffness > 0.0 && std::isfinite(limit.any_user->stiffness)) {
    any_user.frequency = limit.any_user->frequency;
  }
  return limits;
}

/// A force that moves the device against its dry friction.
double moving_force(const Device& device) {
  double friction = 0.0;
  for (const Body& body : device.bodies()) friction += body.coulomb;
  return above_friction * friction;
}

}  // namespace

std::optional<OptionProblem> find_problem(const WallOptions& options, const Device& device) {
  return find_place_problem(options.damper_on_drive, options.controller.damping, options.controller.contact, device);
}

std::optional<OptionProblem> find_problem(const LimitOptions& options, const Device& device) {
  return find_place_problem(options.damper_on_drive, device.parameters().wall.damping,
                            ControllerOptions::Contact::bilateral, device);
}

std::optional<OptionProblem> find_problem(const RelayTrialsOptions& options, const Device& device) {
  return find_place_problem(options.damper_on_drive, device.parameters().wall.damping,
                            ControllerOptions::Contact::bilateral, device);
}

double default_force(const Device& device, std::optional<double> force_limit) {
  const CriticalStiffness predicted = critical_stiffness(device);
  const auto limit = force_limit ? force_limit : device.parameters().actuator.force_limit;
  const double most = limit ? share_of_force * *limit : std::numeric_limits<double>::infinity();
  if (predicted.status != StiffnessStatus::finite) return limit ? most : std::max(1.0, moving_force(device));
  const double distance = std::max(swing, swing_steps * device.parameters().sensor.resolution);
  return std::min(most, std::max(distance * predicted.stiffness, moving_force(device)));
}

MeasureOptions default_measurement(const Device& device) {
  const double rate = 1.0 / device.loop().sampling_period;
  const CriticalStiffness predicted = critical_stiffness(device);
  const double centre = hertz(frequency_of(predicted));
  MeasureOptions options;
  ExcitationOptions& excitation = options.excitation;
  excitation.kind = ExcitationKind::multisine;
  excitation.highest_hz =
      std::min(std::max(band_above * centre, band_above_highest * highest_crossover(device, predicted)),
               highest_of_nyquist * 0.5 * rate);
  excitation.lowest_hz = std::min(centre / band_below, 0.5 * excitation.highest_hz);
  excitation.periods = measured_periods + transient_periods;
  const double samples = std::ceil(cycles_of_lowest / excitation.lowest_hz * rate);  // of a period, whole
  excitation.duration = static_cast<double>(excitation.periods) * samples / rate;
  excitation.amplitude = default_force(device);
  return options;
}

LimitOptions default_limit(const Device& device) {
  const CriticalStiffness predicted = critical_stiffness(device);
  std::optional<double> any_user;
  if (const auto limit = any_user_limit(device)) any_user = limit->lower_bound();
  LimitOptions options;
  if (auto search = limit_search_options(device, predicted, any_user)) {
    options.search = *std::move(search);
  } else {  // an oscillation is looked for all the same
    options.search.frequencies.push_back(frequency_of(predicted));
    for (const Crossover& each : predicted.crossovers) options.search.frequencies.push_back(each.frequency);
    options.search.floor = device.parameters().sensor.resolution;
  }
  add_frequencies(device, options.search.frequencies);
  double slowest = frequency_of(predicted);
  if (device_has_user(device))
    slowest = std::min(slowest, frequency_of(critical_stiffness(device_without_user(device))));
  options.dwell = std::max(shortest_dwell, dwell_cycles * 2.0 * std::numbers::pi / slowest);
  options.impulse = default_force(device);
  return options;
}

RigCheck check(const Device& device, Driver& driver, const RigOptions& options, double duration) {
  RigCheck result;
  {
    RigRun run(driver, options.limits, device.loop().sampling_period);
    Segment segment;
    segment.cycles = cycles_of(duration, device);
    (void)run.play(segment);
    const SessionStart start = nudged(run, device, driver, options, {.need = SignNeed::to_be_told});
    result.session = ended(run, start, options);
  }
  result.trust = trust_of(device);
  if (result.session.nudge && result.session.stop == StopReason::none &&
      result.session.nudge->reading == NudgeReading::not_told) {
    result.trust.doubt(finding_of(*result.session.nudge, device.parameters().motion));
  }
  if (result.session.stop != StopReason::none) {
    result.trust.refuse({.code = FindingCode::check_cut_short, .subjects = {{"reason", explanation(result.session)}}});
  }
  return result;
}

RigMeasurement measure(const Device& device, Driver& driver, const RigOptions& options,
                       const MeasureOptions& measurement, const Progress& progress) {
  RigMeasurement result;
  result.trust = trust_of(device);
  result.excitation = excite(measurement.excitation, device);
  RigRun run(driver, options.limits, device.loop().sampling_period);
  Segment segment;
  segment.force = result.excitation.samples;
  segment.cycles = segment.force.size();
  segment.ramps = true;
  report(progress, 0.0);
  Played played = run.play(segment);
  result.session = ended(run, {device}, options);
  report(progress, 0.5);
  if (result.session.stop != StopReason::none) {
    judge(result, device);
    return result;
  }
  result.recording = recording_of(std::move(played), device, driver);
  FrequencyResponseOptions response;
  response.excitation = FrequencyResponseOptions::Excitation::periodic;
  response.period = result.excitation.period;
  result.response = frequency_response(result.recording, response);
  if (driver.facts().is_simulated) result.response->trust.inherit(result.trust);
  judge(result, device);
  report(progress, 1.0);
  return result;
}

RigIdentification identify_on_rig(const Device& device, Driver& driver, const RigOptions& options,
                                  const MeasureOptions& measurement, const Progress& progress) {
  require_open_damper(device);
  RigIdentification result{measure(device, driver, options, measurement, {}), {}, trust_of(device)};
  if (!result.measurement.response) {
    result.trust.inherit(result.measurement.trust);
    return result;
  }
  IdentifyOptions identification;
  identification.response.excitation = FrequencyResponseOptions::Excitation::periodic;
  identification.response.period = result.measurement.excitation.period;
  result.identification = identify(result.measurement.recording, device, identification, progress);
  if (driver.facts().is_simulated) inherit(result.trust, *result.identification);
  result.trust.inherit(result.identification->trust);
  return result;
}

RigWall render_wall(const Device& device, Driver& driver, const RigOptions& options, const WallOptions& wall) {
  require_valid(find_problem(wall, device));
  RigWall result;
  result.controller = wall.controller;
  result.damper_on_drive = wall.damper_on_drive;
  result.predicted = critical_stiffness(device);
  result.trust = result.predicted.trust;
  predict(device, result);
  const double period = device.loop().sampling_period;
  const double frequency = frequency_of(result.predicted);
  Segment segment;
  segment.controller = on_host(wall.controller, wall.damper_on_drive);
  segment.cycles = cycles_of(wall.duration, device);
  segment.ramps = true;
  segment.watched.push_back(frequency);
  for (const Crossover& each : result.predicted.crossovers) segment.watched.push_back(each.frequency);
  add_frequencies(device, segment.watched);
  segment.watch_floor = 2.0 * device.parameters().sensor.resolution;
  const std::size_t ramped = std::min(segment.cycles, cycles_of(options.limits.ramp, device));
  segment.cut_from = ramped;
  std::size_t after = 0;
  if (wall.impulse != 0.0) {
    segment.force.assign(ramped, 0.0);
    const std::vector<double> impulse = impulse_at(frequency, wall.impulse, period);
    segment.force.insert(segment.force.end(), impulse.begin(), impulse.end());
    after = segment.cut_from = segment.watch_from = std::min(segment.cycles, segment.force.size());
  }
  if (wall.damper_on_drive) {
    driver.close_damper(rendering(device, wall.controller), options.limits.force);
    doubt_estimator(driver, result.trust);
  }
  RigRun run(driver, options.limits, period, options.watcher);
  const auto knock = wall.impulse != 0.0 ? std::optional(std::abs(wall.impulse)) : std::nullopt;
  const SessionStart start =
      nudged(run, device, driver, options, {.damping = wall.controller.damping, .most_force = knock});
  Played played = run.play(segment);
  result.session = ended(run, start, options, played.stop);
  result.oscillates = played.stop == StopReason::oscillation;
  result.peak_force = largest(played.force);
  result.peak_position = largest(played.position);
  if (played.position.size() > after) {
    const std::span<const double> rest = std::span(played.position).subspan(after);
    result.ring = least_damped_oscillation(rest, period, segment.watched, device.parameters().sensor.resolution);
  }
  result.cut_duration = static_cast<double>(ramped < segment.cycles ? played.cut : segment.cycles) * period;
  result.recording = recording_of(std::move(played), device, driver);
  judge(result);
  return result;
}

RigLimit measure_limit(const Device& device, Driver& driver, const RigOptions& options, const LimitOptions& limit,
                       const Progress& progress) {
  require_valid(find_problem(limit, device));
  RigLimit result;
  result.predicted = critical_stiffness(device);
  result.any_user = any_user_limit(device);
  result.limits = limits_beside(device, result);
  result.impulse = limit.impulse;
  const double period = device.loop().sampling_period;
  LimitSearch search(limit.search);
  const std::vector<double> impulse = impulse_at(frequency_of(result.predicted), limit.impulse, period);
  if (limit.damper_on_drive) {
    driver.close_damper(device, options.limits.force);
    doubt_estimator(driver, result.predicted.trust);
  }
  RigRun run(driver, options.limits, period, options.watcher);
  const SessionStart begun =
      nudged(run, device, driver, options,
             {.damping = device.parameters().wall.damping, .most_force = std::abs(limit.impulse)});
  const auto hosted = [&](double stiffness) { return on_host(wall_of(device, stiffness), limit.damper_on_drive); };
  Segment holding;
  holding.controller = hosted(limit.search.start);
  holding.cycles = cycles_of(std::max(0.5 * limit.dwell, options.limits.ramp), device);
  holding.ramps = true;
  holding.watched = limit.search.frequencies;
  holding.watch_floor = 2.0 * limit.search.floor;
  const auto with_impulse = [&](double stiffness, double share) {
    if (stiffness < holding.controller.stiffness) holding.controller.stiffness = stiffness;  // the start was unstable
    (void)run.play(holding);
    holding.ramps = false;
    holding.cycles = cycles_of(0.5 * limit.dwell, device);
    Segment segment;
    segment.controller = hosted(stiffness);
    segment.force = impulse;
    for (double& force : segment.force) force *= share;
    segment.cycles = impulse.size() + cycles_of(limit.dwell, device);
    segment.watched = limit.search.frequencies;
    segment.watch_floor = 2.0 * limit.search.floor;
    segment.cut_from = segment.watch_from = impulse.size();
    return run.play(segment);
  };
  const auto after_impulse = [&](const Played& played) {
    return std::span(played.position).subspan(std::min(impulse.size(), played.position.size()));
  };
  std::size_t trials = 0;
  while (const auto stiffness = search.next()) {
    const Played played = with_impulse(*stiffness, 1.0);
    if (run.is_stopped()) break;
    search.add(*stiffness, after_impulse(played), period, played.stop == StopReason::oscillation, played.cut > 0);
    report(progress, part(++trials, LimitSearch::most_trials));
  }
  if (const auto stiffness = search.next_smaller(); stiffness && !run.is_stopped()) {
    for (int i = 0; i < holds_before_smaller; ++i) (void)run.play(holding);  // what is left of larger swings dies out
    const Played played = with_impulse(*stiffness, LimitSearch::smaller_impulse);
    if (!run.is_stopped()) search.add_smaller(after_impulse(played), period);
  }
  result.session = ended(run, begun, options);
  result.measured = search.measurement(device);
  if (result.session.stop != StopReason::none && !result.measured.stiffness) {
    result.measured.trust.refuse(
        {.code = FindingCode::search_cut_short, .subjects = {{"reason", explanation(result.session)}}});
  }
  judge(result, device);
  return result;
}

}  // namespace zwidth::rig
