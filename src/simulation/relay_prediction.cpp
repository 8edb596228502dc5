#include "zwidth/simulation/relay_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/known_structure.hpp"
#include "simulation/check_relay.hpp"
#include "simulation/loop_schedule.hpp"
#include "staged_progress.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double lowest_share = 0.2;           // of the lowest crossover's frequency
constexpr double longest_half_period = 10000;  // samples
constexpr double most_work = 1e9;              // half-periods times states cubed
constexpr double without_crossover = 2000;     // samples, where no crossover gives a scale

double half_period_samples(const CriticalStiffness& linear, double period) {
  double lowest = 0.0;
  for (const Crossover& each : linear.crossovers) {
    if (each.frequency > 0.0 && (lowest == 0.0 || each.frequency < lowest)) lowest = each.frequency;
  }
  if (lowest == 0.0) return without_crossover;
  return std::min(longest_half_period, std::ceil(std::numbers::pi / (lowest_share * lowest * period)));
}

}  // namespace

RelayPrediction relay_prediction(const Device& device, const Relay& relay, const Progress& progress) {
  require_known_friction(device);
  check_relay(relay);
  StagedProgress stages(progress);
  stages.next(0.1);
  const double period = device.loop().sampling_period;
  const double delay = device.loop().delay;
  RelayPrediction prediction;
  DeviceParameters without_spring = device.parameters();
  without_spring.wall = {};
  if (damper_runs_apart(device)) {
    without_spring.wall.damping = device.parameters().wall.damping;
    without_spring.wall.velocity_filter_hz = device.parameters().wall.velocity_filter_hz;
  }
  prediction.linear = critical_stiffness(Device(std::move(without_spring)));
  if (damper_runs_apart(device)) {
    prediction.lowest_frequency = std::numbers::pi / period;
    if (prediction.linear.trust.refused()) return prediction;
    stages.next(1.0);
    prediction.describing_function = describing_function_limit_cycles(device, relay, stages.stage());
    stages.done();
    return prediction;
  }
  const ContinuousStateSpace system = state_space(device);
  const double states = static_cast<double>(system.A.rows());
  const double longest =
      std::max(2.0, std::min(half_period_samples(prediction.linear, period), most_work / std::pow(states, 3)));
  prediction.lowest_frequency = std::numbers::pi / (longest * period);
  stages.next(0.5);
  prediction.describing_function = describing_function_limit_cycles(device, relay, stages.stage());
  stages.next(0.7);
  prediction.sampled_relay = sampled_relay_limit_cycles(sample(system, {period, delay}), relay,
                                                        static_cast<std::size_t>(longest), stages.stage());
  stages.next(1.0);
  prediction.continuous_relay =
      relay_limit_cycles(system, relay, period, longest * period, delay + 0.5 * period, stages.stage());
  stages.done();
  return prediction;
}

}  // namespace zwidth
