#include "identification/friction_test.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "linear_systems.hpp"
#include "signal/fourier.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_samples = 512;
constexpr std::size_t most_samples = std::size_t{1} << 17U;

using Signal = std::vector<double>;

Signal motion(const Device& device, std::span<const double> force) {
  return forced_response(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), force);
}

Device with(const Device& device, const std::string& key, double value) {
  DeviceParameters parameters = device.parameters();
  set_parameter(parameters, key, value);
  return Device(std::move(parameters));
}

/// The change of the motion as a parameter grows by a typical amount of itself.
std::optional<Signal> slope(const FrictionQuestion& question, const std::string& key, std::span<const double> force,
                            const Signal& own) {
  const Device& device = question.device;
  const auto value = parameter(device.parameters(), key);
  if (!value) return std::nullopt;
  const double unit = key == "loop.delay" || key == "actuator.time_constant" ? question.sampling_period : *value;
  if (!(unit > 0.0)) return std::nullopt;
  constexpr double step = 1e-4;
  Signal change = motion(
      device_in_experiment(with(device, key, *value + step * unit), question.locked, question.sampling_period), force);
  for (std::size_t i = 0; i < change.size(); ++i) change[i] = (change[i] - own[i]) / step;
  return change;
}

struct Sliding {
  std::string body;
  Signal effect;  ///< on the sensed position, of unit friction
};

/// What unit friction at each body does to the sensed position.
std::vector<Sliding> friction_effects(const Device& device, std::span<const double> force) {
  std::vector<Sliding> effects;
  for (std::size_t body = 0; body < device.bodies().size(); ++body) {
    DeviceParameters seen = device.parameters();
    seen.loop.sensed = body;
    const Signal position = motion(Device(seen), force);
    Signal opposing(position.size(), 0.0);
    bool moves = false;
    for (std::size_t k = 0; k + 1 < position.size(); ++k) {
      const double velocity = position[k + 1] - position[k];
      opposing[k] = velocity > 0.0 ? -1.0 : velocity < 0.0 ? 1.0 : 0.0;
      moves = moves || velocity != 0.0;
    }
    if (!moves) continue;
    DeviceParameters pushed = device.parameters();
    pushed.loop.actuated = body;
    pushed.loop.delay = 0.0;
    pushed.actuator.time_constant = 0.0;
    effects.push_back({device.bodies()[body].name, motion(Device(pushed), opposing)});
  }
  return effects;
}

/// The lines of a windowed signal within the band.
Eigen::VectorXcd lines_of(const Signal& signal, std::size_t first, std::size_t last) {
  Signal windowed(signal.size());
  const double turn = 2.0 * std::numbers::pi / static_cast<double>(signal.size());
  for (std::size_t k = 0; k < signal.size(); ++k) {
    windowed[k] = signal[k] * 0.5 * (1.0 - std::cos(turn * static_cast<double>(k)));
  }
  const auto all = spectrum(windowed);
  Eigen::VectorXcd lines(static_cast<Eigen::Index>(last - first));
  for (std::size_t i = first; i < last; ++i) lines(static_cast<Eigen::Index>(i - first)) = all[i];
  return lines;
}

/// 1 / rms of the values around each line.
Eigen::VectorXd weights_of(const Eigen::VectorXcd& rest) {
  constexpr Eigen::Index reach = 12;
  const Eigen::Index n = rest.size();
  const double least = 1e-12 * rest.squaredNorm() / static_cast<double>(n);
  Eigen::VectorXd weights(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index begin = std::max<Eigen::Index>(0, i - reach);
    const Eigen::Index count = std::min(n, i + reach + 1) - begin;
    weights(i) = 1.0 / std::sqrt(rest.segment(begin, count).squaredNorm() / static_cast<double>(count) + least);
  }
  return weights;
}

struct Regression {
  Eigen::VectorXd values;
  Eigen::VectorXd deviations;
  Eigen::VectorXcd rest;
};

std::optional<Regression> regress(const Eigen::MatrixXcd& columns, const Eigen::VectorXcd& target,
                                  const Eigen::VectorXd& weights) {
  const Eigen::Index n = target.size();
  Eigen::MatrixXd left(2 * n, columns.cols());
  Eigen::VectorXd right(2 * n);
  left << (weights.asDiagonal() * columns.real()), (weights.asDiagonal() * columns.imag());
  right << weights.cwiseProduct(target.real()), weights.cwiseProduct(target.imag());
  const Eigen::VectorXd scale = left.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  left = left * scale.asDiagonal();
  const auto [solution, deviations] = shortest_least_squares(left, right);
  Regression found;
  found.values = scale.cwiseProduct(solution);
  found.rest = target - columns * found.values;
  const double left_over = (right - left * solution).squaredNorm();
  const double freedom = std::max(1.0, static_cast<double>(2 * n - columns.cols()));
  // A Hann window makes neighbouring lines share: 1.94 times the variance of independent ones.
  constexpr double shared = 1.94;
  found.deviations = scale.cwiseProduct(deviations) * std::sqrt(shared * left_over / freedom);
  if (!found.values.allFinite() || !found.deviations.allFinite()) return std::nullopt;
  return found;
}

}  // namespace

std::vector<std::vector<double>> free_motions(const Device& device, std::size_t size) {
  const DiscreteStateSpace system = sample(state_space(device), {device.loop().sampling_period, 0.0});
  std::vector<Signal> motions;
  for (Eigen::Index i = 0; i < system.Phi.rows(); ++i) {
    Eigen::VectorXd state = Eigen::VectorXd::Unit(system.Phi.rows(), i);
    Signal position(size);
    for (double& y : position) {
      y = system.C.dot(state);
      state += system.Phi * state;
    }
    motions.push_back(std::move(position));
  }
  return motions;
}

std::optional<FrictionEvidence> find_friction(const FrictionQuestion& question, std::span<const double> force,
                                              std::span<const double> position) {
  const Device device = device_in_experiment(question.device, question.locked, question.sampling_period);
  const std::size_t size = std::min(force.size(), most_samples);
  if (size < least_samples) return std::nullopt;
  force = force.first(size);
  const Signal own = motion(device, force);
  Signal rest(position.begin(), position.begin() + static_cast<std::ptrdiff_t>(size));
  for (std::size_t i = 0; i < size; ++i) rest[i] -= own[i];
  std::vector<Signal> columns = free_motions(device, size);
  for (const std::string& key : question.free) {
    if (auto change = slope(question, key, force, own)) columns.push_back(*std::move(change));
  }
  columns.push_back(motion(device, Signal(size, 1.0)));
  columns.emplace_back(size, 1.0);
  const std::vector<Sliding> effects = friction_effects(device, force);
  const double step = 2.0 * std::numbers::pi / (device.loop().sampling_period * static_cast<double>(size));
  const auto first = std::max<std::size_t>(2, static_cast<std::size_t>(question.lowest / step));
  const auto last = std::min(size / 2, static_cast<std::size_t>(std::ceil(2.0 * question.highest / step)) + 1);
  if (last < first + 4 * (columns.size() + 1)) return std::nullopt;
  Eigen::MatrixXcd known(static_cast<Eigen::Index>(last - first), static_cast<Eigen::Index>(columns.size() + 1));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    known.col(static_cast<Eigen::Index>(j)) = lines_of(columns[j], first, last);
  }
  const Eigen::VectorXcd target = lines_of(rest, first, last);
  // Less than this share of the force is what rounds off the record's numbers, where they have no other noise.
  constexpr double least_friction = 1e-6;
  double largest_force = 0.0;
  for (const double each : force) largest_force = std::max(largest_force, std::abs(each));
  std::optional<FrictionEvidence> best;
  double best_ratio = 0.0;
  for (const Sliding& each : effects) {
    const Eigen::Index friction = known.cols() - 1;
    known.col(friction) = lines_of(each.effect, first, last);
    std::optional<Regression> found;
    Eigen::VectorXcd left = target;
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
      found = regress(known, target, weights_of(left));
      if (!found) break;
      left = found->rest;
    }
    if (!found || !(found->deviations(friction) > 0.0)) continue;
    if (found->values(friction) < least_friction * largest_force) continue;
    const double ratio = found->values(friction) / found->deviations(friction);
    if (best && ratio <= best_ratio) continue;
    best_ratio = ratio;
    best = FrictionEvidence{each.body, found->values(friction), found->deviations(friction)};
  }
  return best;
}

}  // namespace zwidth::internal
