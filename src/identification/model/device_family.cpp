#include "identification/model/device_family.hpp"

#include <algorithm>
#include <utility>

#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

constexpr const char* delay_of_loop = "loop.delay";
constexpr const char* lag_of_actuator = "actuator.time_constant";

}  // namespace

DeviceFamily::DeviceFamily(DeviceParameters structure, std::vector<Number> numbers, std::vector<std::string> locked)
    : structure_(std::move(structure)), numbers_(std::move(numbers)), locked_(std::move(locked)) {
  structure_.uncertainty.reset();
  for (const Number& each : numbers_) {
    if (parameter(structure_, each.key)) ++of_device_;
    has_lag_ = has_lag_ || each.key == lag_of_actuator;
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

DeviceParameters DeviceFamily::device_at(const Eigen::VectorXd& x) const {
  DeviceParameters values = values_at(x);
  if (!has_lag_) return values;
  double& lag = values.actuator.time_constant;
  lag = std::min(lag, values.loop.delay);
  values.loop.delay -= lag;
  return values;
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
  Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(numbers_.size()));
  for (Eigen::Index i = 0; i < of_device_; ++i) {
    const Number& number = numbers_[static_cast<std::size_t>(i)];
    double value = *parameter(device, number.key);
    if (has_lag_ && number.key == delay_of_loop) value += device.actuator.time_constant;
    x(i) = number.coordinate(value);
  }
  return x;
}

}  // namespace zwidth::internal
