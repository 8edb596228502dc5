#include "zwidth/simulation/relay.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <tuple>
#include <utility>

#include "counted.hpp"
#include "doubt_all.hpp"
#include "model/known_structure.hpp"
#include "simulation/loop_schedule.hpp"
#include "simulation/relay_explanation.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double same_period = 0.01;  // relative
constexpr double trials_share = 0.7;  // of the progress

double friction_level(const Device& device, double amplitude) {
  double largest = 0.0;
  for (const Body& body : device.bodies()) largest = std::max(largest, body.coulomb);
  return largest / amplitude;
}

Trust trust_of_reading(const RelayResult& result) {
  Trust trust;
  // A device that is refused predicts nothing; what a recording shows stands beside it.
  const Trust expected = result.prediction ? result.prediction->linear.trust
                         : result.device   ? trust_of(*result.device)
                                           : Trust{};
  doubt_all(expected, trust);
  if (const auto over_all = relay_mean(result.trials); over_all && !result.mean) {
    trust.refuse({.code = FindingCode::trials_settle_apart,
                  .evidence = {{"trials", static_cast<double>(over_all->trials)}},
                  .subjects = {{"oscillations", oscillations_text(result)}}});
    return trust;
  }
  if (!result.mean) {
    trust.refuse({.code = FindingCode::no_trial_oscillates});
    return trust;
  }
  if (!result.device) {
    trust.doubt({.code = FindingCode::relay_without_device});
  } else if (expected.refused()) {
    // its reasons are there
  } else if (result.prediction && result.prediction->linear.status != StiffnessStatus::finite) {
    trust.doubt({.code = FindingCode::relay_without_finite_limit});
  } else if (result.limit_reading == LimitReading::unsafe) {
    trust.doubt({.code = FindingCode::relay_reads_more,
                 .evidence = {{"stiffness", result.mean->stiffness},
                              {"decibels", decibels(result.mean->stiffness / result.prediction->linear.stiffness)}},
                 .effect = {{"critical_stiffness", result.prediction->linear.stiffness}}});
  } else if (result.limit_reading == LimitReading::too_cautious) {
    trust.doubt({.code = FindingCode::relay_reads_less,
                 .evidence = {{"stiffness", result.mean->stiffness},
                              {"decibels", -decibels(result.mean->stiffness / result.prediction->linear.stiffness)},
                              {"samples_per_cycle",
                               2.0 * std::numbers::pi / (result.mean->frequency * result.sampling_period)}},
                 .effect = {{"critical_stiffness", result.prediction->linear.stiffness}}});
  }
  return trust;
}

/// What follows from the trials and the device.
void conclude(RelayResult& result, const Progress& progress) {
  const std::optional<RelayMean> over_all = relay_mean(result.trials);
  if (over_all && agree(*over_all)) result.mean = over_all;
  if (result.device && result.relay.amplitude > 0.0) {
    result.friction_level = friction_level(*result.device, result.relay.amplitude);
    if (!trust_of(*result.device).refused()) {
      result.prediction = relay_prediction(*result.device, result.relay, progress);
    }
  }
  if (result.mean && result.prediction) result.limit_reading = limit_reading(*result.mean, result.prediction->linear);
  if (over_all && result.prediction) result.explanation = relay_explanation(result);
  result.trust = trust_of_reading(result);
  if (!result.device) return;
  const Wall& wall = result.device->parameters().wall;
  if (damper_runs_apart(*result.device)) {
    result.remarks.push_back(note({.code = FindingCode::left_out_beside_damper_loop, .subjects = {{"what", "relay"}}}));
  } else if (wall.damping > 0.0 || !wall.filters.empty()) {
    result.remarks.push_back(note({.code = FindingCode::relay_without_wall, .key = "wall"}));
  }
}

void add_recorded_trial(RelayResult& result, Recording recording, const RelayAnalysisOptions& analysis) {
  if (recording.channels.size() != 2) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::recording_without_two_channels,
                                              .evidence = {internal::counted("channels", recording.channels.size())}});
  }
  RelayTrial trial;
  trial.force = std::move(recording.channels[0].samples);
  trial.position = std::move(recording.channels[1].samples);
  trial.result = analyse_relay_record(trial.force, trial.position, result.sampling_period, analysis);
  if (!trial.force.empty()) {
    const auto [lowest, highest] = std::minmax_element(trial.force.begin(), trial.force.end());
    result.relay.amplitude = std::max(result.relay.amplitude, 0.5 * (*highest - *lowest));
  }
  result.trials.push_back(std::move(trial));
  std::ranges::move(recording.remarks, std::back_inserter(result.remarks));
  const RelayTrial& recorded = result.trials.back();
  for (const auto& [name, samples, role] : {std::tuple("force", &recorded.force, SignalRole::force),
                                            std::tuple("position", &recorded.position, SignalRole::position)}) {
    for (Remark& remark : check_signal({name, *samples}, result.sampling_period, role)) {
      result.remarks.push_back(std::move(remark));
    }
  }
}

}  // namespace

tl::expected<Device, DeviceProblem> with_added_delay(const Device& device, double added) {
  if (!(std::isfinite(added) && added >= 0.0)) {
    return tl::unexpected(
        device_problem("", {.code = ProblemCode::negative, .evidence = {{"value", added}}, .subjects = {{"in", "s"}}}));
  }
  DeviceParameters parameters = device.parameters();
  parameters.loop.delay += added;
  if (auto problem = find_problem(parameters)) return tl::unexpected(*std::move(problem));
  return Device(std::move(parameters));
}

std::optional<RelayMean> relay_mean(const std::vector<RelayTrial>& trials) {
  RelayMean mean;
  double log_stiffness = 0.0;
  for (const RelayTrial& trial : trials) {
    if (!trial.result) continue;
    const RelayReading& reading = *trial.result;
    const bool is_first = mean.trials++ == 0;
    mean.frequency += reading.frequency;
    log_stiffness += std::log(reading.stiffness);
    mean.amplitude += reading.amplitude;
    mean.lowest_frequency = is_first ? reading.frequency : std::min(mean.lowest_frequency, reading.frequency);
    mean.highest_frequency = std::max(mean.highest_frequency, reading.frequency);
  }
  if (mean.trials == 0) return std::nullopt;
  const auto count = static_cast<double>(mean.trials);
  mean.frequency /= count;
  mean.stiffness = std::exp(log_stiffness / count);
  mean.amplitude /= count;
  return mean;
}

std::optional<OptionProblem> find_problem(const RelayRecordOptions& options, double sampling_period) {
  if (!(std::isfinite(options.hysteresis) && options.hysteresis >= 0.0)) {
    return option_problem("hysteresis", {.code = ProblemCode::below_bound,
                                         .evidence = {{"value", options.hysteresis}, {"bound", 0.0}},
                                         .subjects = {{"measure", "position"}}});
  }
  if (auto problem = find_problem(options.analysis)) {
    problem->member.insert(0, "analysis.");
    return problem;
  }
  if (!options.device) return std::nullopt;
  const double expected = options.device->loop().sampling_period;
  if (std::abs(sampling_period / expected - 1.0) <= same_period) return std::nullopt;
  return option_problem("device.loop.sampling_period",
                        {.code = ProblemCode::sampling_periods_disagree,
                         .evidence = {{"expected", expected}, {"period", sampling_period}}});
}

RelayResult relay(const Device& device, const RelayOptions& options, const Progress& progress) {
  require_known_friction(device);
  RelayResult result;
  result.motion = device.parameters().motion;
  result.sampling_period = device.loop().sampling_period;
  result.relay = options.relay;
  result.device = device;
  if (trust_of(device).refused()) {  // nor are trials of it
    require_valid(find_problem(options, device));
    result.trust = trust_of(device);
    return result;
  }
  StagedProgress stages(progress);
  stages.next(trials_share);
  result.trials = relay_trials(device, options, stages.stage());
  stages.next(1.0);
  conclude(result, stages.stage());
  stages.done();
  return result;
}

RelayResult relay(Recording recording, const RelayRecordOptions& options, const Progress& progress) {
  std::vector<Recording> recordings;
  recordings.push_back(std::move(recording));
  return relay(std::move(recordings), options, progress);
}

RelayResult relay(std::vector<Recording> recordings, const RelayRecordOptions& options, const Progress& progress) {
  if (recordings.empty()) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::no_recording});
  require_valid(find_problem(options, recordings.front().sampling_period));
  RelayResult result;
  result.source = RelayResult::Source::recording;
  result.recording = recordings.front().source;
  result.motion = options.device ? options.device->parameters().motion : options.motion;
  result.sampling_period = recordings.front().sampling_period;
  result.relay.hysteresis = options.hysteresis;
  for (Recording& recording : recordings) {
    if (recording.sampling_period != result.sampling_period) {
      throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::recordings_of_two_periods});
    }
    add_recorded_trial(result, std::move(recording), options.analysis);
  }
  result.device = options.device;
  conclude(result, progress);
  return result;
}

}  // namespace zwidth
