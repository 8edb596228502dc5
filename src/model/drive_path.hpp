#pragma once

#include <complex>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// What force and position pass between the controller and the device: the actuator's lag, and the drive that tracks the position.
//
//     E(s) = 1/(lag s + 1) (2 w s + w²)/(s + w)²
struct DrivePath {
  double lag = 0.0;       // s; 0: none
  double tracking = 0.0;  // w, rad/s; 0: none

  [[nodiscard]] bool is_ideal() const { return lag == 0.0 && tracking == 0.0; }

  // E(jw), w of either sign, in a complex number of the caller's.
  template <typename Number = std::complex<double>>
  [[nodiscard]] Number response(typename Number::value_type frequency) const {
    using Real = typename Number::value_type;
    Number value(Real(1.0));
    if (lag > 0.0) value /= Number(Real(1.0), Real(lag) * frequency);
    if (tracking > 0.0) {
      const Real ratio = frequency / Real(tracking);
      const Number behind = Number(Real(1.0)) / Number(Real(1.0), ratio);
      value *= Number(Real(1.0), Real(2.0) * ratio) * behind * behind;
    }
    return value;
  }
};

[[nodiscard]] inline DrivePath drive_path_of(const DeviceParameters& device) {
  return {device.actuator.time_constant, device.sensor.tracking_bandwidth};
}

}  // namespace zwidth::internal
