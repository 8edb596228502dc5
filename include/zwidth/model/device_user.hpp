#pragma once

#include "zwidth/model/device.hpp"

namespace zwidth {

/// Whether the device file names a user: an [operator] with a mass, a damping or a stiffness.
[[nodiscard]] bool device_has_user(const Device& device);

/// The device held by this user instead of its own. What is doubted of the device stays; an uncertainty of the user that is
/// taken away goes, with the numbers that were known together with it.
[[nodiscard]] Device device_with_user(const Device& device, const User& user);

/// The device that nobody holds, as device_with_user() of no mass, damping and stiffness.
[[nodiscard]] Device device_without_user(const Device& device);

}  // namespace zwidth
