#include "identification/verdict/log_critical_stiffness.hpp"

#include <cmath>
#include <utility>

#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

std::optional<double> log_critical_stiffness(DeviceParameters device) {
  device.wall.damping = 0.0;
  if (find_problem(device)) return std::nullopt;
  const CriticalStiffness found = critical_stiffness(Device(std::move(device)));
  const bool is_finite = found.status == StiffnessStatus::finite && found.stiffness > 0.0;
  return is_finite ? std::optional(std::log(found.stiffness)) : std::nullopt;
}

}  // namespace zwidth::internal
