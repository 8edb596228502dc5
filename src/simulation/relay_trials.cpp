#include "zwidth/simulation/relay_trials.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "require_valid.hpp"
#include "staged_progress.hpp"
#include "thread_arena.hpp"
#include "zwidth/error.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t samples_per_report = 1 << 10;

std::size_t samples_per_trial(const Device& device, const RelayOptions& options) {
  if (!device.has_bodies() && options.start_offset != 0.0) {
    throw Error(ErrorCode::needs_bodies, "a start offset needs bodies; a transfer function starts at rest at 0");
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
  options.initial_position.assign(parameters.bodies.size(), trial.start_offset);
  return HybridLoop(Device(std::move(parameters)), options);
}

void run(RelayTrial& trial, HybridLoop loop, std::size_t samples, SharedProgress& progress) {
  trial.force.reserve(samples);
  trial.position.reserve(samples);
  std::size_t reported = 0;
  for (std::size_t k = 1; k <= samples; ++k) {
    loop.step();
    trial.force.push_back(loop.command());
    trial.position.push_back(loop.measured());
    if (k - reported < samples_per_report && k < samples) continue;
    progress.add(k - reported);
    reported = k;
  }
}

}  // namespace

std::optional<OptionProblem> find_problem(const RelayOptions& options, const Device& device) {
  const auto problem = [](const char* member, auto value, std::string allowed) {
    return OptionProblem{member, fmt::format("is {}", value), std::move(allowed)};
  };
  const double amplitude = options.relay.amplitude;
  if (!(std::isfinite(options.relay.hysteresis) && options.relay.hysteresis >= 0.0)) {
    return problem("relay.hysteresis", options.relay.hysteresis, "a position in m or rad, 0 or more");
  }
  if (auto wrong = find_problem(options.analysis)) {
    wrong->member.insert(0, "analysis.");
    return wrong;
  }
  constexpr double largest = 1e30;  // as of a device's numbers: squares of it are still numbers
  if (!(amplitude > 0.0 && amplitude <= largest)) {
    return problem("relay.amplitude", amplitude, "a force in N or N m above 0, at most 1e30");
  }
  const auto limit = device.parameters().actuator.force_limit;
  if (limit && amplitude > *limit) {
    return problem("relay.amplitude", amplitude, fmt::format("at most the device's actuator.force_limit, {}", *limit));
  }
  if (!std::isfinite(options.start_offset)) {
    return problem("start_offset", options.start_offset, "a position in m or rad");
  }
  if (!device.has_bodies() && options.start_offset != 0.0) {
    return problem("start_offset", options.start_offset, "a transfer function starts at rest at 0");
  }
  if (!(options.variation >= 0.0 && options.variation < 1.0)) {
    return problem("variation", options.variation, "a relative variation, 0 up to, but not including, 1");
  }
  if (options.trials == 0) return problem("trials", options.trials, "at least 1");
  if (!(std::isfinite(options.duration) && options.duration > 0.0)) {
    return problem("duration", options.duration, "seconds above 0");
  }
  const double samples = std::round(options.duration / device.loop().sampling_period);
  if (samples < least_relay_samples || samples * static_cast<double>(options.trials) > most_relay_samples) {
    return OptionProblem{
        "duration", fmt::format("{} trials of {} s are {:.6g} samples each", options.trials, options.duration, samples),
        fmt::format("at least {}, at most {} in all", least_relay_samples, most_relay_samples)};
  }
  if (device.loop().delay >= options.duration) {
    return OptionProblem{
        "duration",
        fmt::format("{} s is no longer than the loop's delay of {} s", options.duration, device.loop().delay),
        "a longer run"};
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
