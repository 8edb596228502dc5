#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "rig/action_steps.hpp"
#include "rig/rig_actions.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::rig {
namespace {

constexpr int most_holds = 100;               // before a trial of a relay
constexpr double at_rest = 1e-5;              // of the swing
constexpr double holding_share = 0.1;         // of the predicted limit: a stiffer wall takes more of the damping away
constexpr double holding_cycles = 4.0;        // of the predicted oscillation, in each
constexpr double beginning_cycles = 10.0;     // of it, before a trial is read
constexpr double beginning_hysteresis = 0.5;  // of the swing that a relay is expected to make
constexpr double highest_of_other = 0.98;     // of Nyquist's frequency

/// The wall without damper and filters that a device comes back to its start with, where theory has one.
Segment centring(const Device& device, double stiffness, double duration) {
  Segment segment;
  segment.controller.kind = ControllerOptions::Kind::wall;
  segment.controller.stiffness = stiffness;
  segment.cycles = cycles_of(duration, device);
  return segment;
}

/// Whether a relay may find another, faster oscillation than that of the limit: at a crossover below Nyquist's frequency.
bool has_faster_oscillations(const CriticalStiffness& predicted, double sampling_period) {
  if (predicted.status != StiffnessStatus::finite || !predicted.limit) return false;
  const double highest = highest_of_other * std::numbers::pi / sampling_period;
  return std::ranges::any_of(predicted.crossovers, [&](const Crossover& each) {
    return each.frequency > predicted.limit->frequency && each.frequency < highest;
  });
}

/// By the relay's first harmonic at the limit, m or rad.
double expected_swing(double amplitude, const CriticalStiffness& predicted) {
  return 4.0 * amplitude / (std::numbers::pi * predicted.stiffness);
}

/// How a trial begins that seeks the oscillation of the limit, of which nothing is read: with a force that grows, and a
/// hysteresis of half the swing that is expected: what oscillates less, at crossovers of stiffer walls, does not pass it.
/// Nothing where there is no faster oscillation: from a force that grows a trial would settle elsewhere among the
/// oscillations that a sampled relay holds side by side.
Segment seeking(const Segment& trial, const Device& device, const CriticalStiffness& predicted, double ramp) {
  Segment beginning = trial;
  beginning.ramps = true;
  beginning.cycles = 0;
  if (!has_faster_oscillations(predicted, device.loop().sampling_period)) return beginning;
  const double duration = std::max(ramp, beginning_cycles * 2.0 * std::numbers::pi / frequency_of(predicted));
  beginning.cycles = cycles_of(duration, device);
  beginning.controller.hysteresis = std::max(
      trial.controller.hysteresis, beginning_hysteresis * expected_swing(trial.controller.amplitude, predicted));
  return beginning;
}

/// Holds the device until it moves a small share of what it swung, or by no more than a step of its encoder, or has been
/// held long enough: where it rests.
double bring_to_rest(RigRun& run, const Segment& holding, double least) {
  double rest = 0.0;
  for (int i = 0; i < most_holds && !run.is_stopped(); ++i) {
    const std::vector<double> position = run.play(holding).position;
    if (position.empty()) break;
    rest = position.back();
    const auto [lowest, highest] = std::ranges::minmax(position);
    if (highest - lowest <= least) break;
  }
  return rest;
}

/// A relay takes the place of the wall that the host would run; the drive's damper stays beside it.
Device without_wall_of_host(const Device& device) {
  if (has_damper_loop(device.loop())) return device;
  DeviceParameters parameters = device.parameters();
  parameters.wall = {};
  return Device(std::move(parameters));
}

}  // namespace

RigRelay relay_on_rig(const Device& device, Driver& driver, const RigOptions& options, const RelayTrialsOptions& trials,
                      const Progress& progress) {
  require_valid(find_problem(trials, device));
  const CriticalStiffness predicted = critical_stiffness(without_wall_of_host(device));
  RigRelay result;
  result.trust = trust_of(device);
  if (trials.damper_on_drive) driver.close_damper(device, options.limits.force);
  RigRun run(driver, options.limits, device.loop().sampling_period);
  const SessionStart start =
      nudged(run, device, driver, options,
             {.damping = device.parameters().wall.damping, .most_force = trials.relay.amplitude});
  Segment segment;
  segment.controller.kind = ControllerOptions::Kind::relay;
  segment.controller.amplitude = trials.relay.amplitude;
  segment.controller.hysteresis = trials.relay.hysteresis;
  std::vector<Recording> recordings;
  segment.cycles = cycles_of(trials.duration, device);
  Segment beginning;
  if (trials.seek_limit) beginning = seeking(segment, device, predicted, options.limits.ramp);
  const bool can_hold = predicted.status == StiffnessStatus::finite;
  Segment holding;  // the session begins with it, whatever it can hold
  holding.cycles = cycles_of(options.limits.ramp, device);
  double swung = 0.0;
  if (can_hold) {
    holding =
        centring(device, holding_share * predicted.stiffness,
                 std::max(options.limits.ramp, holding_cycles * 2.0 * std::numbers::pi / frequency_of(predicted)));
    swung = expected_swing(trials.relay.amplitude, predicted);
  }
  holding.ramps = true;
  for (std::size_t i = 0; i < trials.trials && !run.is_stopped(); ++i) {
    if (i == 0 || can_hold) {
      segment.controller.position = beginning.controller.position =
          bring_to_rest(run, holding, std::max(at_rest * swung, 0.5 * device.parameters().sensor.resolution));
    }
    holding.ramps = false;
    (void)run.play(beginning);
    Played played = run.play(segment);
    if (run.is_stopped()) break;
    recordings.push_back(recording_of(std::move(played), device, driver));
    swung = largest(recordings.back().channels[1].samples);
    report(progress, part(i + 1, trials.trials));
  }
  result.session = ended(run, start, options);
  if (recordings.empty()) {
    result.trust.refuse(
        {.code = FindingCode::first_trial_cut_short, .subjects = {{"reason", explanation(result.session)}}});
    return result;
  }
  RelayRecordOptions record;
  record.device = device;
  record.hysteresis = trials.relay.hysteresis;
  record.analysis = trials.analysis;
  result.relay = relay(std::move(recordings), record);
  result.trust.inherit(result.relay->trust);
  return result;
}

}  // namespace zwidth::rig
