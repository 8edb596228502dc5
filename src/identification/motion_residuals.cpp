#include "identification/motion_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "zwidth/model/parameter.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_followed = 512;
constexpr std::size_t most_followed = std::size_t{1} << 17U;

using Signal = std::vector<double>;

Device with(const Device& device, const std::string& key, double value) {
  DeviceParameters parameters = device.parameters();
  set_parameter(parameters, key, value);
  return Device(std::move(parameters));
}

}  // namespace

MotionResiduals::MotionResiduals(const MotionQuestion& question, std::span<const double> force,
                                 std::span<const double> position)
    : question_(question),
      device_(device_in_experiment(question.device, question.locked, question.sampling_period)),
      force_(force.first(std::min(force.size(), most_followed))) {
  const std::size_t size = force_.size();
  if (size < least_followed) return;
  const Signal own = motion_of(device_, force_);
  Signal rest(position.begin(), position.begin() + static_cast<std::ptrdiff_t>(size));
  for (std::size_t i = 0; i < size; ++i) rest[i] -= own[i];
  for (const std::string& key : question.free) {
    if (auto found = slope(key, own)) slopes_.push_back(*std::move(found));
  }
  std::vector<Signal> others = free_motions(device_, size);
  others.push_back(motion_of(device_, Signal(size, 1.0)));
  others.emplace_back(size, 1.0);
  band_ = band_with_harmonics(question.lowest, question.highest, size, question.sampling_period);
  const std::size_t count = slopes_.size() + others.size();
  are_enough_ = band_.size() >= 4 * (count + 1);
  if (!are_enough_) return;
  known_.resize(static_cast<Eigen::Index>(band_.size()), static_cast<Eigen::Index>(count));
  Eigen::Index column = 0;
  for (const Slope& each : slopes_) known_.col(column++) = lines_of(each.change, band_);
  for (const Signal& each : others) known_.col(column++) = lines_of(each, band_);
  target_ = lines_of(rest, band_);
}

std::optional<MotionResiduals::Slope> MotionResiduals::slope(const std::string& key, const Signal& own) const {
  const Device& device = question_.device;
  const auto value = parameter(device.parameters(), key);
  if (!value) return std::nullopt;
  const double unit = key == "loop.delay" || key == "actuator.time_constant" ? question_.sampling_period : *value;
  if (!(unit > 0.0)) return std::nullopt;
  constexpr double step = 1e-4;
  Signal change = motion_of(
      device_in_experiment(with(device, key, *value + step * unit), question_.locked, question_.sampling_period),
      force_);
  for (std::size_t i = 0; i < change.size(); ++i) change[i] = (change[i] - own[i]) / step;
  return Slope{key, unit, std::move(change)};
}

std::vector<Opposing> MotionResiduals::opposing_forces(const std::function<double(double)>& size) const {
  std::vector<Opposing> forces;
  for (std::size_t body = 0; body < device_.bodies().size(); ++body) {
    DeviceParameters seen = device_.parameters();
    seen.loop.sensed = body;
    const Signal opposing = opposing_force(motion_of(Device(std::move(seen)), force_), question_.sampling_period, size);
    if (std::ranges::all_of(opposing, [](double each) { return each == 0.0; })) continue;
    forces.push_back({device_.bodies()[body].name, motion_of(pushed_at(device_, body), opposing)});
  }
  return forces;
}

std::optional<LineRegression> MotionResiduals::beside(const Opposing& force) const {
  const Eigen::Index rows = known_.rows();
  auto found = regress_lines(known_, lines_of(force.effect, band_), target_, {&rows, 1});
  if (found && !(found->deviations(known_.cols()) > 0.0)) return std::nullopt;
  return found;
}

RestLines MotionResiduals::rest() const {
  return {known_,
          target_,
          {{0, force_.size(), band_}},
          {known_.rows()},
          Eigen::VectorXcd::Ones(known_.rows()),
          [this](std::span<const double> motion) { return lines_of(motion, band_); }};
}

DeviceParameters MotionResiduals::parameters_beside(const LineRegression& found) const {
  DeviceParameters parameters = question_.device.parameters();
  parameters.uncertainty.reset();
  for (std::size_t i = 0; i < slopes_.size(); ++i) {
    const auto& [key, unit, change] = slopes_[i];
    constexpr double least = 0.1;
    const double value = parameter(parameters, key).value_or(0.0);
    set_parameter(parameters, key, std::max(least * value, value + found.values(static_cast<Eigen::Index>(i)) * unit));
  }
  return parameters;
}

std::vector<double> opposing_force(std::span<const double> positions, double sampling_period,
                                   const std::function<double(double)>& size) {
  Signal opposing(positions.size(), 0.0);
  for (std::size_t k = 0; k + 1 < positions.size(); ++k) {
    const double velocity = (positions[k + 1] - positions[k]) / sampling_period;
    if (velocity != 0.0) opposing[k] = std::copysign(size(std::abs(velocity)), -velocity);
  }
  return opposing;
}

Device pushed_at(const Device& device, std::size_t body) {
  DeviceParameters parameters = device.parameters();
  parameters.loop.actuated = body;
  parameters.loop.delay = 0.0;
  parameters.actuator.time_constant = 0.0;
  return Device(std::move(parameters));
}

std::vector<double> motion_of(const Device& device, std::span<const double> force) {
  return forced_response(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), force);
}

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

}  // namespace zwidth::internal
