#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "linear_systems.hpp"
#include "simulation/check_relay.hpp"
#include "simulation/loop_schedule.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "staged_progress.hpp"
#include "zwidth/simulation/limit_cycle.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;
constexpr int max_newton_steps = 12;
constexpr double tolerance = 1e-11;           // on the logarithms of frequency and dampings
constexpr double difference_step = 1e-6;      // of the same
constexpr double largest_move = 0.3;          // of the logarithm of the frequency, per share of friction
constexpr double largest_damping_move = 3.0;  // of the logarithm of each damping
constexpr double shortest_step = 1e-5;        // of the share of friction
constexpr double stiffest = 1e4;              // c_max over the device's mass times w
constexpr double stuck_share = 0.01;          // of c_max, from which on a body counts as stuck
constexpr std::size_t most_followed = 50;
constexpr int frequencies_scanned = 20000;
constexpr double lowest_of_nyquist = 1e-6;  // where the scan begins

LimitCycle cycle_at(double frequency, double stiffness, const Relay& relay) {
  return {frequency, 4.0 * relay.amplitude / (pi * stiffness), stiffness};
}

bool has_friction(const Device& device) {
  for (const Body& body : device.bodies()) {
    if (body.coulomb > 0.0) return true;
  }
  return false;
}

/// Friction as the damping of its first harmonic, balanced with the relay.
///
///     Im P(e^{jwT}) = -pi h / (4 d)
///     c_i = 4 F_i / (pi V_i),  V_i = w |G_i(jw)| 4 d / pi      for every body i with friction
///
/// P and G_i (from the actuator to body i) are those of the device with the dampings c_i. Unknowns: ln w and all ln
/// c_i.
class FrictionBalance {
 public:
  FrictionBalance(const Device& device, const Relay& relay, const Progress& progress)
      : device_(device), relay_(relay), progress_(progress) {
    for (std::size_t i = 0; i < device.bodies().size(); ++i) {
      total_mass_ += device.bodies()[i].mass;
      if (device.bodies()[i].coulomb > 0.0) rubbing_.push_back(i);
    }
  }

  /// Unknowns near a cycle of the device without friction.
  [[nodiscard]] Eigen::VectorXd guess(double frequency, double share) const {
    Eigen::VectorXd unknowns(1 + static_cast<Eigen::Index>(rubbing_.size()));
    unknowns[0] = std::log(frequency);
    for (std::size_t k = 0; k < rubbing_.size(); ++k) {
      unknowns[1 + static_cast<Eigen::Index>(k)] = std::log(damping(device_, k, frequency, share));
    }
    return unknowns;
  }

  [[nodiscard]] Eigen::VectorXd excess(const Eigen::VectorXd& unknowns, double share) const {
    const double frequency = std::exp(unknowns[0]);
    const Device damped = with_damping(unknowns);
    const std::complex<double> plant = response(sampled_plant(damped), frequency);
    Eigen::VectorXd result(unknowns.size());
    result[0] = (plant.imag() + pi * relay_.hysteresis / (4.0 * relay_.amplitude)) / std::abs(plant);
    for (std::size_t k = 0; k < rubbing_.size(); ++k) {
      const auto row = 1 + static_cast<Eigen::Index>(k);
      result[row] = unknowns[row] - std::log(damping(damped, k, frequency, share));
    }
    return result;
  }

  /// Newton's method from `unknowns`; nothing where it does not settle within max_newton_steps, or strays.
  [[nodiscard]] std::optional<Eigen::VectorXd> solved(Eigen::VectorXd unknowns, double share) const {
    const Eigen::VectorXd start = unknowns;
    const double highest = std::log(pi / device_.loop().sampling_period);
    for (int i = 0; i < max_newton_steps; ++i) {
      tell(progress_, 0.0);
      const Eigen::VectorXd at = excess(unknowns, share);
      Eigen::MatrixXd jacobian(at.size(), at.size());
      for (Eigen::Index k = 0; k < at.size(); ++k) {
        Eigen::VectorXd moved = unknowns;
        moved[k] -= difference_step;  // downwards: never past Nyquist
        jacobian.col(k) = (at - excess(moved, share)) / difference_step;
      }
      const Eigen::VectorXd step = solve_pivoted(jacobian, -at);
      if (!step.allFinite()) return std::nullopt;
      unknowns += step;
      const Eigen::VectorXd moved = (unknowns - start).cwiseAbs();
      const bool strays = moved[0] > largest_move || moved.maxCoeff() > largest_damping_move;
      if (strays || unknowns[0] > highest) return std::nullopt;
      if (step.cwiseAbs().maxCoeff() < tolerance) return unknowns;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<LimitCycle> cycle(const Eigen::VectorXd& unknowns) const {
    const double frequency = std::exp(unknowns[0]);
    const Device damped = with_damping(unknowns);
    for (std::size_t k = 0; k < rubbing_.size(); ++k) {
      // What pushes, or what the relay sees, does not move: no oscillation.
      const bool matters = rubbing_[k] == device_.loop().actuated || rubbing_[k] == device_.loop().sensed;
      if (matters && sliding_damping(damped, k, frequency, 1.0) > stuck_share * sticking_damping(frequency))
        return std::nullopt;
    }
    const std::complex<double> plant = response(sampled_plant(damped), frequency);
    const LimitCycle found = cycle_at(frequency, 1.0 / std::abs(plant), relay_);
    if (plant.real() >= 0.0 || found.amplitude <= relay_.hysteresis) return std::nullopt;
    return found;
  }

 private:
  /// 4 F / (pi V) of the k-th body with friction, as it moves in `device`.
  [[nodiscard]] double sliding_damping(const Device& device, std::size_t k, double frequency, double share) const {
    DeviceParameters seen = device.parameters();
    seen.loop.sensed = rubbing_[k];
    seen.sensor.tracking_bandwidth = 0.0;  // what the body does, not what the drive reads of it
    const double mobility = frequency * std::abs(response(modal_form(Device(std::move(seen))), frequency));
    return share * device_.bodies()[rubbing_[k]].coulomb / (relay_.amplitude * mobility);
  }

  [[nodiscard]] double sticking_damping(double frequency) const { return stiffest * total_mass_ * frequency; }

  /// c of the k-th body with friction, as it moves in `device`: exact to (c/c_max)^2 for a body that slides.
  [[nodiscard]] double damping(const Device& device, std::size_t k, double frequency, double share) const {
    return 1.0 / std::hypot(1.0 / sliding_damping(device, k, frequency, share), 1.0 / sticking_damping(frequency));
  }

  [[nodiscard]] Device with_damping(const Eigen::VectorXd& unknowns) const {
    DeviceParameters parameters = device_.parameters();
    for (std::size_t k = 0; k < rubbing_.size(); ++k) {
      parameters.bodies[rubbing_[k]].damping += std::exp(unknowns[1 + static_cast<Eigen::Index>(k)]);
    }
    return Device(std::move(parameters));
  }

  const Device& device_;
  Relay relay_;
  const Progress& progress_;
  double total_mass_ = 0.0;
  std::vector<std::size_t> rubbing_;
};

/// Follows one cycle while friction grows from nothing to its full share; nothing where the balance is lost.
std::optional<LimitCycle> with_friction(const Device& device, const LimitCycle& frictionless, const Relay& relay,
                                        const Progress& progress) {
  const FrictionBalance balance(device, relay, progress);
  double share = 0.0;
  double step = 1.0;
  std::optional<Eigen::VectorXd> unknowns;
  while (share < 1.0) {
    const double next = std::min(share + step, 1.0);
    Eigen::VectorXd guess = balance.guess(frictionless.frequency, next);
    if (unknowns) {
      guess = *unknowns;
      guess.tail(guess.size() - 1).array() += std::log(next / share);
    }
    if (auto found = balance.solved(std::move(guess), next)) {
      unknowns = std::move(found);
      share = next;
      step *= 2.0;
    } else {
      step *= 0.5;
      if (step < shortest_step) return std::nullopt;
    }
  }
  return balance.cycle(*unknowns);
}

/// With hysteresis: Im P = -pi h / (4 d), Re P < 0, X = 4 d |P| / pi.
std::vector<LimitCycle> with_hysteresis(const SampledPlant& plant, const Relay& relay) {
  const double wanted = -pi * relay.hysteresis / (4.0 * relay.amplitude);
  const auto excess = [&](double frequency) { return response(plant, frequency).imag() - wanted; };
  const double nyquist = pi / plant.period;
  const double step = std::pow(1.0 / lowest_of_nyquist, 1.0 / frequencies_scanned);
  std::vector<LimitCycle> cycles;
  double lower = nyquist * lowest_of_nyquist;
  double at_lower = excess(lower);
  for (int i = 1; i <= frequencies_scanned; ++i) {
    const double upper = i == frequencies_scanned ? nyquist : lower * step;
    const double at_upper = excess(upper);
    if ((at_lower < 0.0) != (at_upper < 0.0)) {
      std::uintmax_t iterations = 100;
      const auto [a, b] = boost::math::tools::toms748_solve(excess, lower, upper, at_lower, at_upper,
                                                            boost::math::tools::eps_tolerance<double>(48), iterations);
      const double frequency = 0.5 * (a + b);
      const std::complex<double> value = response(plant, frequency);
      if (value.real() < 0.0 && 4.0 * relay.amplitude * std::abs(value) / pi > relay.hysteresis) {
        cycles.push_back(cycle_at(frequency, 1.0 / std::abs(value), relay));
      }
    }
    lower = upper;
    at_lower = at_upper;
  }
  return cycles;
}

std::vector<LimitCycle> without_hysteresis(const SampledPlant& plant, const Relay& relay) {
  std::vector<LimitCycle> cycles;
  for (const Crossover& each : critical_stiffness(filtered_plant(plant, {})).crossovers) {
    if (each.frequency > 0.0) cycles.push_back(cycle_at(each.frequency, each.stiffness, relay));
  }
  return cycles;
}

/// Nothing where the damper that runs apart makes it another plant from sample to sample, or rubs too.
std::optional<SampledPlant> seen_by_relay(const Device& device) {
  if (!damper_runs_apart(device)) return sampled_plant(device);
  const TwoRateDevice loop(device, device.parameters().wall.damping);
  if (!loop.is_damper_inside() || has_friction(device)) return std::nullopt;
  return loop.seen_by_spring();
}

}  // namespace

std::vector<LimitCycle> describing_function_limit_cycles(const Device& device, const Relay& relay,
                                                         const Progress& progress) {
  StagedProgress stages(progress);
  check_relay(relay);
  const std::optional<SampledPlant> plant = seen_by_relay(device);
  if (!plant) return {};
  const std::vector<LimitCycle> frictionless =
      relay.hysteresis > 0.0 ? with_hysteresis(*plant, relay) : without_hysteresis(*plant, relay);
  if (!has_friction(device)) return frictionless;
  std::vector<double> stiffnesses;
  for (const LimitCycle& each : frictionless) stiffnesses.push_back(each.stiffness);
  std::sort(stiffnesses.begin(), stiffnesses.end());
  std::vector<LimitCycle> cycles;
  for (const LimitCycle& each : frictionless) {
    stages.next(static_cast<double>(&each - frictionless.data() + 1) / static_cast<double>(frictionless.size()));
    if (stiffnesses.size() > most_followed && each.stiffness >= stiffnesses[most_followed]) continue;
    if (const auto cycle = with_friction(device, each, relay, stages.stage())) cycles.push_back(*cycle);
  }
  stages.done();
  return cycles;
}

}  // namespace zwidth
