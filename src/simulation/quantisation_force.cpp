#include "simulation/quantisation_force.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "simulation/loop_schedule.hpp"
#include "simulation/oscillation_cycles.hpp"

namespace zwidth::internal {
namespace {

constexpr double threshold = 0.5;         // of the ripple: what makes a cycle
constexpr std::size_t fewest_cycles = 2;  // less shows no frequency
constexpr double rounding = 1e-9;         // of the force of one step: a difference below is none

bool is_faulty(const Faults& faults) {
  return faults.lost_sample_probability > 0.0 || faults.sampling_jitter > 0.0 || faults.overrun_probability > 0.0;
}

}  // namespace

QuantisationForceObserver::QuantisationForceObserver(const Device& device, const HybridLoopOptions& loop,
                                                     std::size_t samples)
    : observes_(device.parameters().sensor.resolution > 0.0 && !is_faulty(loop.faults) &&
                loop.controller.kind == ControllerOptions::Kind::wall && !damper_runs_apart(device, loop.controller)),
      exact_(loop.controller, device.loop().sampling_period),
      limit_(device.parameters().actuator.force_limit.value_or(std::numeric_limits<double>::infinity())),
      period_(device.loop().sampling_period),
      first_(samples - samples / 4) {
  if (observes_) differences_.reserve(samples - first_);
}

void QuantisationForceObserver::note(double position, double command) {
  if (!observes_) return;
  const double exact = std::clamp(exact_.update(position), -limit_, limit_);
  if (noted_++ < first_) return;
  if (!differences_.empty() && command != last_command_) {
    ++changes_;
    last_change_ = noted_;
  }
  last_command_ = command;
  differences_.push_back(command - exact);
}

std::optional<QuantisationForce> QuantisationForceObserver::found() const {
  // What rests between two steps of the encoder makes no ripple, however the place within them decays.
  constexpr std::size_t still = 10;  // the last part of the run
  const bool goes_on = noted_ - last_change_ < noted_ / still;
  if (changes_ < 2 * fewest_cycles || !goes_on) return std::nullopt;
  const auto [low, high] = std::minmax_element(differences_.begin(), differences_.end());
  const double amplitude = 0.5 * (*high - *low);
  const double largest = std::max(std::abs(*low), std::abs(*high));
  if (!(amplitude > rounding * largest)) return std::nullopt;
  std::vector<double> centred = differences_;
  for (double& each : centred) each -= *low + amplitude;
  const OscillationCycles cycles = oscillation_cycles(centred, threshold * amplitude);
  if (cycles.count < fewest_cycles) return std::nullopt;
  const double most_often =
      0.5 * static_cast<double>(changes_) / static_cast<double>(differences_.size());  // per sample
  return QuantisationForce{amplitude,
                           2.0 * std::numbers::pi * std::min(1.0 / cycles.mean_length, most_often) / period_};
}

}  // namespace zwidth::internal
