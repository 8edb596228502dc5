#include "identification/model/device_family.hpp"

#include <algorithm>
#include <utility>

#include "model/loop_keys.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {}  // namespace

DeviceFamily::DeviceFamily(DeviceParameters structure, std::vector<Number> numbers, std::vector<std::string> locked)
    : structure_(std::move(structure)), numbers_(std::move(numbers)), locked_(std::move(locked)) {
  structure_.uncertainty.reset();
  for (const Number& each : numbers_) {
    if (parameter(structure_, each.key)) ++of_device_;
    has_lag_ = has_lag_ || each.key == key_of_lag;
    has_damping_drift_ = has_damping_drift_ || each.key == key_of_damping_drift;
    has_delay_drift_ = has_delay_drift_ || each.key == key_of_delay_drift;
  }
  of_limit_ = of_device_;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const bool drifts = numbers_[i].key == key_of_damping_drift || numbers_[i].key == key_of_delay_drift;
    if (drifts) of_limit_ = static_cast<Eigen::Index>(i) + 1;
  }
}

DeviceParameters DeviceFamily::values_at(const Eigen::VectorXd& x) const {
  DeviceParameters values = structure_;
  for (Eigen::Index i = 0; i < of_device_; ++i) {
    const Number& number = numbers_[static_cast<std::size_t>(i)];
    set_parameter(values, number.key, number.value(x(i)));
  }
  return values;
}

double DeviceFamily::value_of(const std::string& key, const Eigen::VectorXd& x) const {
  const auto place = std::ranges::find(numbers_, key, &Number::key) - numbers_.begin();
  return numbers_[static_cast<std::size_t>(place)].value(x(place));
}

DeviceParameters DeviceFamily::device_at(const Eigen::VectorXd& x) const { return finished(values_at(x)); }

DeviceParameters DeviceFamily::device_at(const Eigen::VectorXd& x, const DriftInstants& instants) const {
  constexpr double middle = 0.5;
  DeviceParameters values = values_at(x);
  if (has_damping_drift_) {
    const double left = std::max(0.0, 1.0 + value_of(key_of_damping_drift, x) * (instants.damping - middle));
    for (Body& body : values.bodies) {
      if (std::ranges::find(numbers_, "body." + body.name + ".damping", &Number::key) != numbers_.end())
        body.damping *= left;
    }
  }
  if (has_delay_drift_)
    values.loop.delay = std::max(0.0, values.loop.delay + value_of(key_of_delay_drift, x) * instants.delay);
  return finished(std::move(values));
}

DeviceParameters DeviceFamily::finished(DeviceParameters values) const {
  if (!has_lag_) return values;
  double& lag = values.actuator.time_constant;
  lag = std::min(lag, values.loop.delay);
  values.loop.delay -= lag;
  return values;
}

bool DeviceFamily::has_device_at(const Eigen::VectorXd& x) const {
  DeviceParameters values = device_at(x);
  if (find_problem(values)) return false;
  values = values_at(x);
  values.loop.delay = 0.0;
  return !find_problem(values);
}

double DeviceFamily::played_delay(const Eigen::VectorXd& x) const {
  const DeviceParameters values = values_at(x);
  return values.loop.delay - (has_lag_ ? values.actuator.time_constant : 0.0);
}

Device DeviceFamily::recorded_device(const Eigen::VectorXd& x) const {
  DeviceParameters values = values_at(x);
  values.loop.delay = 0.0;
  const Device device(std::move(values));
  std::vector<std::size_t> still;
  for (const std::string& name : locked_) still.push_back(device.body_index(name));
  return still.empty() ? device : locked_device(device, still);
}

Eigen::VectorXd DeviceFamily::coordinates_of(const DeviceParameters& device) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(numbers_.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Number& number = numbers_[static_cast<std::size_t>(i)];
    x(i) = number.start;
    std::optional<double> value = parameter(device, number.key);
    if (!value) continue;
    if (has_lag_ && number.key == key_of_delay) *value += device.actuator.time_constant;
    x(i) = number.coordinate(*value);
  }
  return x;
}

}  // namespace zwidth::internal
