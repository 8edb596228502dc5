#pragma once

#include "zwidth/model/device.hpp"

namespace zwidth {

/// Whether the device file names a user: an [operator] with a mass, a damping or a stiffness.
[[nodiscard]] bool has_operator(const Device& device);

/// The device held by this user instead of its own. What is doubted of the device stays; an uncertainty of the user that is
/// taken away goes, with the numbers that were known together with it.
[[nodiscard]] Device with_operator(const Device& device, const Operator& user);

/// The device that nobody holds, as with_operator() of no mass, damping and stiffness.
[[nodiscard]] Device without_operator(const Device& device);

}  // namespace zwidth
