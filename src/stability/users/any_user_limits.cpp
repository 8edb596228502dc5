#include "stability/users/any_user_limits.hpp"

#include <utility>

#include "stability/limit/two_rate_stiffness.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {
namespace {

Device free_with(const Device& free, VirtualDamper damper) {
  DeviceParameters parameters = free.parameters();
  parameters.uncertainty.reset();
  parameters.wall.damping = damper.damping;
  parameters.wall.velocity_filter_hz = damper.velocity_filter_hz;
  return Device(std::move(parameters));
}

}  // namespace

AnyUserLimits::AnyUserLimits(const Device& device, const Progress& progress) : free_(device_without_user(device)) {
  if (!has_damper_loop(device.loop())) {
    (void)one_rate(progress);
    return;
  }
  if (!bounds_all_users(device)) require_one_rate(device);
  tell(progress, 0.0);
  two_rates_.emplace(free_);
}

AbsoluteStabilitySearch& AnyUserLimits::one_rate(const Progress& progress) {
  if (!one_rate_) one_rate_.emplace(with_one_rate(free_), progress);
  return *one_rate_;
}

AbsoluteStabilityLimit AnyUserLimits::limit(VirtualDamper damper, const Progress& progress) {
  if (!two_rates_ || damper.damping == 0.0) return one_rate(progress).limit(damper, progress);
  tell(progress, 0.0);
  return two_rates_->limit(damper, unguarded_stiffness(free_with(free_, damper)));
}

std::vector<double> AnyUserLimits::ends_of_damper(double velocity_filter_hz) const {
  return two_rates_ ? two_rates_->ends_of_damper(velocity_filter_hz) : std::vector<double>{};
}

}  // namespace zwidth::internal
