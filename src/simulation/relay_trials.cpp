#include "zwidth/simulation/relay_trials.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "counted.hpp"
#include "simulation/loop_schedule.hpp"
#include "staged_progress.hpp"
#include "thread_arena.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t samples_per_report = 1 << 10;

std::size_t samples_per_trial(const Device& device, const RelayOptions& options) {
  if (!device.has_bodies() && options.start_offset != 0.0) {
    throw Error(ErrorCode::needs_bodies, {.code = ProblemCode::start_offset_without_bodies});
  }
  require_valid(find_problem(options, device));
  return static_cast<std::size_t>(std::round(options.duration / device.loop().sampling_period));
}

/// The trials, drawn but not yet run.
std::vector<RelayTrial> drawn_trials(const RelayOptions& options) {
  std::mt19937_64 random(options.seed);
  const auto factor = [&] {
    const double uniform = static_cast<double>(random() >> 11) * 0x1p-53;  // the same on every platform
    return 1.0 + options.variation * (2.0 * uniform - 1.0);
  };
  std::vector<RelayTrial> trials(options.trials);
  for (RelayTrial& trial : trials) {
    trial.start_offset = options.start_offset * factor();
    trial.friction_factor = factor();
  }
  return trials;
}

HybridLoop loop_of(const Device& device, const Relay& relay, const RelayTrial& trial) {
  DeviceParameters parameters = device.parameters();
  for (Body& body : parameters.bodies) body.coulomb *= trial.friction_factor;
  HybridLoopOptions options;
  options.controller.kind = ControllerOptions::Kind::relay;
  options.controller.amplitude = relay.amplitude;
  options.controller.hysteresis = relay.hysteresis;
  if (damper_runs_apart(device)) {
    options.controller.damping = parameters.wall.damping;
    options.controller.velocity_filter_hz = parameters.wall.velocity_filter_hz;
  }
  options.initial_position.assign(parameters.bodies.size(), trial.start_offset);
  return {Device(std::move(parameters)), options};
}

void run(RelayTrial& trial, HybridLoop loop, std::size_t samples, SharedProgress& progress) {
  trial.force.reserve(samples);
  trial.position.reserve(samples);
  std::size_t reported = 0;
  for (std::size_t k = 1; k <= samples; ++k) {
    loop.step();
    trial.force.push_back(loop.spring_command());
    trial.position.push_back(loop.measured());
    if (k - reported < samples_per_report && k < samples) continue;
    progress.add(k - reported);
    reported = k;
  }
}

}  // namespace

std::optional<OptionProblem> find_problem(const RelayOptions& options, const Device& device) {
  using enum ProblemCode;
  const auto problem = [](const char* member, ProblemCode code, double value, std::vector<Subject> subjects = {}) {
    return option_problem(
        member, {.code = code, .evidence = {{"value", value}, {"bound", 0.0}}, .subjects = std::move(subjects)});
  };
  const double amplitude = options.relay.amplitude;
  if (!(std::isfinite(options.relay.hysteresis) && options.relay.hysteresis >= 0.0)) {
    return problem("relay.hysteresis", below_bound, options.relay.hysteresis, {{"measure", "position"}});
  }
  if (auto wrong = find_problem(options.analysis)) {
    wrong->member.insert(0, "analysis.");
    return wrong;
  }
  constexpr double largest = 1e30;  // as of a device's numbers: squares of it are still numbers
  if (!(amplitude > 0.0 && amplitude <= largest)) {
    return problem("relay.amplitude", relay_force_out_of_range, amplitude);
  }
  const auto limit = device.parameters().actuator.force_limit;
  if (limit && amplitude > *limit) {
    return option_problem("relay.amplitude",
                          {.code = relay_force_above_limit, .evidence = {{"value", amplitude}, {"most", *limit}}});
  }
  if (!std::isfinite(options.start_offset)) {
    return problem("start_offset", not_finite, options.start_offset);
  }
  if (!device.has_bodies() && options.start_offset != 0.0) {
    return problem("start_offset", transfer_function_starts_at_rest, options.start_offset);
  }
  if (!(options.variation >= 0.0 && options.variation < 1.0)) {
    return problem("variation", no_share_below_one, options.variation);
  }
  if (options.trials == 0) {
    return option_problem("trials", {.code = too_few, .evidence = {{"value", 0.0}, {"least", 1.0}}});
  }
  if (!(std::isfinite(options.duration) && options.duration > 0.0)) {
    return problem("duration", not_finite_and_positive, options.duration, {{"in", "s"}});
  }
  const double samples = std::round(options.duration / device.loop().sampling_period);
  if (samples < least_relay_samples || samples * static_cast<double>(options.trials) > most_relay_samples) {
    return option_problem("duration", {.code = samples_of_trials,
                                       .evidence = {counted("trials", options.trials),
                                                    {"duration", options.duration},
                                                    {"samples", samples},
                                                    counted("least", least_relay_samples),
                                                    counted("most", most_relay_samples)}});
  }
  if (device.loop().delay >= options.duration) {
    return option_problem("duration", {.code = no_force_would_arrive,
                                       .evidence = {{"value", options.duration}, {"delay", device.loop().delay}}});
  }
  return std::nullopt;
}

std::vector<RelayTrial> relay_trials(const Device& device, const RelayOptions& options, const Progress& progress) {
  const std::size_t samples = samples_per_trial(device, options);
  std::vector<RelayTrial> trials = drawn_trials(options);
  SharedProgress shared(progress, samples * options.trials);
  ThreadArena arena(options.threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
      RelayTrial& trial = trials[i];
      run(trial, loop_of(device, options.relay, trial), samples, shared);
      trial.result = analyse_relay_record(trial.force, trial.position, device.loop().sampling_period, options.analysis);
    });
  });
  return trials;
}

}  // namespace zwidth
