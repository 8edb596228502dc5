#pragma once

#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// Devices of nearly the same linear response, whose masses are divided otherwise between two bodies: a linear fit finds
/// any of them, and only their friction, or what is known of a body, tells which is the device's.
///
/// Of two linked bodies, one driven and the other sensed,
///   H(s) = (c s + k) / (m_1 m_2 s (s^3 + a_2 s^2 + a_1 s + a_0)):
/// five coefficients of six numbers. k/(m_1 m_2), c/(m_1 m_2), m_1 + m_2, a_2 and a_0 are kept, a_1 but for
/// b_1 b_2/(m_1 m_2). Empty where the sensed body is driven, of more bodies, with springs to the ground, or where one of the
/// six is not in `free` (keys in full).
[[nodiscard]] std::vector<DeviceParameters> alike_devices(const DeviceParameters& device,
                                                          const std::vector<std::string>& free);

}  // namespace zwidth::internal
