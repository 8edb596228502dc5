#pragma once

#include <string>

#include "identification/model/number.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What the numbers of a device come to in a measurement, where nothing else tells.
struct TypicalSizes {
  double time = 0.0;       ///< s; > 0
  double damping = 0.0;    ///< N s/m or N m s/rad, of a body; > 0
  double stiffness = 0.0;  ///< N/m or N m/rad, to the ground; > 0
};

/// A number of the device itself: masses and link stiffnesses are hardly known beforehand, all others not at all.
///
/// `start`: where a fit begins, which the units come from.
[[nodiscard]] Number device_number(const std::string& key, const DeviceParameters& start, const TypicalSizes& typical);

/// One that a file gives as `value` > 0, log-normal by this deviation of the logarithm.
[[nodiscard]] Number number_about(const std::string& key, double value, double deviation);

}  // namespace zwidth::internal
