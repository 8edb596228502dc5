#include "zwidth/simulation/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "signal/fitted_sine.hpp"
#include "simulation/loop_judgement.hpp"
#include "simulation/loop_schedule.hpp"
#include "simulation/quantisation_force.hpp"
#include "simulation/simulation_remarks.hpp"
#include "simulation/simulation_setup.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double settled_share = 0.02;   // of the largest excursion
constexpr std::size_t end_part = 16;     // of the run: its last sixteenth shows where it ends
constexpr double same_frequency = 0.01;  // relative: a multiple of the user's frequency
constexpr double small_share = 0.01;     // of the user's rhythm: a motion beside it that does not count
constexpr double never = std::numeric_limits<double>::infinity();
constexpr std::size_t samples_per_report = 1 << 10;
constexpr double next_longer = 4.0;  // a run whose length was not asked for and whose verdict is not firm
constexpr double longest = 64.0;     // the same, over the first run
constexpr double most_samples_to_be_firm = 1e6;

/// Keeps every n-th point of the loop.
class TrajectoryKeeper {
 public:
  TrajectoryKeeper(const Device& device, std::size_t samples, std::size_t every)
      : every_(every), bodies_(device.bodies().size()) {
    if (every == 0) return;
    const std::size_t size = samples / every + 1;
    for (auto* each : {&kept_.time, &kept_.measured, &kept_.command, &kept_.user_force}) each->reserve(size);
    const std::size_t columns = std::max<std::size_t>(bodies_, 1);
    kept_.position.resize(columns);
    kept_.velocity.resize(bodies_);
    for (auto& each : kept_.position) each.reserve(size);
    for (auto& each : kept_.velocity) each.reserve(size);
  }

  /// The motion at k T, before the step.
  void note_motion(const HybridLoop& loop) {
    if (!is_kept(loop.sample())) return;
    kept_.time.push_back(loop.time());
    kept_.user_force.push_back(loop.user_force());
    for (std::size_t i = 0; i < bodies_; ++i) {
      kept_.position[i].push_back(loop.position(i));
      kept_.velocity[i].push_back(loop.velocity(i));
    }
    if (bodies_ == 0) kept_.position[0].push_back(loop.sensed_position());
  }

  /// What was measured and commanded at k T, known after the step.
  void note_control(const HybridLoop& loop) {
    if (!is_kept(loop.sample() - 1)) return;
    kept_.measured.push_back(loop.measured());
    kept_.command.push_back(loop.command());
  }

  [[nodiscard]] Trajectory take() { return std::move(kept_); }

 private:
  [[nodiscard]] bool is_kept(std::size_t sample) const { return every_ > 0 && sample % every_ == 0; }

  std::size_t every_;
  std::size_t bodies_;
  Trajectory kept_;
};

std::optional<double> settling_time(const std::vector<double>& position, double period) {
  const auto [end_low, end_high] =
      std::minmax_element(position.end() - static_cast<std::ptrdiff_t>(position.size() / end_part + 1), position.end());
  const double final = 0.5 * (*end_low + *end_high);
  double largest = 0.0;
  for (const double each : position) largest = std::max(largest, std::abs(each - final));
  if (*end_high - *end_low > 2.0 * settled_share * largest) return std::nullopt;
  std::size_t settled = position.size();
  while (settled > 0 && std::abs(position[settled - 1] - final) <= settled_share * largest) --settled;
  return static_cast<double>(settled) * period;
}

/// Energy that the wall takes and gives, by the passivity observer.
class WallEnergy {
 public:
  WallEnergy(const ControllerOptions& wall, double force_limit, double start)
      : wall_(wall), limit_(force_limit), held_at_start_(held(start)) {}

  [[nodiscard]] double generated(double work, double position) const { return work + held(position) - held_at_start_; }

 private:
  /// Integral of min(K p, limit): K p²/2 up to the limit.
  [[nodiscard]] double held(double position) const {
    const double beyond = position - wall_.position;
    const double depth =
        wall_.contact == ControllerOptions::Contact::bilateral ? std::abs(beyond) : std::max(beyond, 0.0);
    const double force = std::min(wall_.stiffness * depth, limit_);
    return force * depth - (force > 0.0 ? 0.5 * force * force / wall_.stiffness : 0.0);
  }

  ControllerOptions wall_;
  double limit_;
  double held_at_start_;
};

/// The sensed positions that the verdict is about: from the start of the user's force on.
std::span<const double> judged(const std::vector<double>& sensed, const UserForce& force, double period) {
  if (force.kind == UserForce::Kind::none) return sensed;
  const double before = std::ceil(force.start / period);
  return std::span(sensed).subspan(before < static_cast<double>(sensed.size()) ? static_cast<std::size_t>(before) : 0);
}

/// Takes the user's rhythm out of the verdict: what is left of the motion is the loop's own.
void judge_beside_sine(Simulation& result, std::span<const double> sensed, const Device& device,
                       const UserForce& force) {
  const double period = device.loop().sampling_period;
  const FittedSine sine = fit_sine(sensed.last(sensed.size() / 2), force.frequency * period);
  const std::vector<double> own = without(sine, sensed);
  const LoopJudgement judgement = judge_loop(own, period, device.parameters().sensor.resolution);
  const double order = judgement.oscillation ? judgement.oscillation->frequency / force.frequency : 0.0;
  const bool is_harmonic =
      judgement.verdict == LoopVerdict::limit_cycle && std::abs(order - std::round(order)) <= same_frequency * order;
  const bool is_small = judgement.oscillation && judgement.oscillation->amplitude <= small_share * sine.amplitude;
  if (judgement.verdict == LoopVerdict::settles || judgement.verdict == LoopVerdict::drifts || is_harmonic ||
      is_small) {
    result.verdict = LoopVerdict::forced;
    result.oscillation = Oscillation{force.frequency, sine.amplitude};
    result.growth_rate = judgement.growth_rate;
    return;
  }
  result.verdict = judgement.verdict;
  result.growth_rate = judgement.growth_rate;
  result.oscillation = judgement.oscillation;
}

void judge(Simulation& result, const std::vector<double>& sensed, const Device& device, const UserForce& force) {
  const double period = device.loop().sampling_period;
  const std::span<const double> part = judged(sensed, force, period);
  if (force.kind == UserForce::Kind::sine) return judge_beside_sine(result, part, device, force);
  const LoopJudgement judgement = judge_loop(part, period, device.parameters().sensor.resolution);
  result.verdict = judgement.verdict;
  result.growth_rate = judgement.growth_rate;
  result.oscillation = judgement.oscillation;
  if (result.verdict == LoopVerdict::settles) result.settling_time = settling_time(sensed, period);
}

/// Whether a longer run would not say more: a device held by a wall comes to rest, swings on or grows.
bool is_firm(const Simulation& result) {
  const ControllerOptions& wall = result.loop.controller;
  const bool holds = wall.kind == ControllerOptions::Kind::wall && wall.stiffness > 0.0 &&
                     wall.contact == ControllerOptions::Contact::bilateral &&
                     result.loop.user_force.kind != UserForce::Kind::ramp;
  return !holds || (result.verdict != LoopVerdict::undecided && result.verdict != LoopVerdict::drifts);
}

void check(const Device& device, const SimulationOptions& options) {
  check_bodies(device, options);
  require_valid(find_problem(options, device));
}

std::size_t samples_per_point(const SimulationOptions& options, std::size_t samples) {
  if (options.keep_every == 0 || !options.keep_at_most) return options.keep_every;
  return std::max(options.keep_every, (samples + *options.keep_at_most - 1) / *options.keep_at_most);
}

/// Runs the loop; what it did is not judged yet. Returns the sensed positions, one more than samples.
std::vector<double> run(Simulation& result, HybridLoop& loop, const Device& device, const SimulationOptions& options,
                        const Progress& progress) {
  const auto samples = static_cast<std::size_t>(std::round(result.duration / device.loop().sampling_period));
  TrajectoryKeeper keeper(device, samples, samples_per_point(options, samples));
  QuantisationForceObserver quantisation_force(device, result.loop, samples);
  const ControllerOptions& wall = result.loop.controller;
  const bool has_wall = wall.kind == ControllerOptions::Kind::wall;
  std::vector<double> sensed;
  sensed.reserve(samples + 1);
  const double start = loop.sensed_position();
  sensed.push_back(start);
  const WallEnergy energy(wall, device.parameters().actuator.force_limit.value_or(never), start);
  if (has_wall) {
    result.generated_energy = 0.0;
    result.peak_penetration = std::max(0.0, start - wall.position);
  }
  for (std::size_t k = 0; k < samples && !result.diverged; ++k) {
    if (progress && k % samples_per_report == 0) progress(static_cast<double>(k) / static_cast<double>(samples));
    keeper.note_motion(loop);
    loop.step();
    keeper.note_control(loop);
    quantisation_force.note(sensed.back(), loop.command());
    const double position = loop.sensed_position();
    sensed.push_back(position);
    result.diverged = !(std::abs(position - start) <= options.divergence);
    if (!has_wall) continue;
    result.generated_energy = energy.generated(loop.work(), position);
    result.peak_generated_energy = std::max(result.peak_generated_energy, *result.generated_energy);
    result.peak_penetration = std::max(result.peak_penetration, position - wall.position);
  }
  if (progress) progress(1.0);
  result.samples = loop.sample();
  result.friction_events = loop.friction_events();
  result.overloaded_steps = loop.overloaded_steps();
  result.final_position = sensed.back();
  result.quantisation_force = quantisation_force.found();
  result.trajectory = keeper.take();
  return sensed;
}

}  // namespace

Simulation simulate(const Device& device, const SimulationOptions& options, const Progress& progress) {
  check(device, options);
  const SimulationSetup setup = simulation_setup(device, options);
  const LinearAnswer linear = linear_answer(device, options);
  const double shortest =
      options.duration.value_or(internal::default_duration(device, linear.critical, options.user_force));
  Simulation result;
  for (double longer = 1.0;; longer *= next_longer) {
    result = {};
    result.loop = setup.loop;
    result.linear = linear;
    result.duration = shortest * longer;
    HybridLoop loop(device, result.loop);
    const std::vector<double> sensed = run(result, loop, device, options, progress);
    if (result.diverged) {
      result.verdict = LoopVerdict::unstable;
    } else {
      judge(result, sensed, device, result.loop.user_force);
    }
    compare_with_linear(result, device, sensed);
    result.remarks = simulation_remarks(result, device, options, sensed);
    if (options.duration || is_firm(result) || longer >= longest ||
        result.duration * next_longer > most_samples_to_be_firm * shortest_period(device, result.loop.controller)) {
      break;
    }
  }
  result.trust = result.linear.critical.trust;
  if (setup.moved_start) result.remarks.insert(result.remarks.begin(), *setup.moved_start);
  return result;
}

}  // namespace zwidth
