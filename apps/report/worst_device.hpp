#pragma once

#include <string>
#include <string_view>

#include "zwidth/model/device.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::report {

/// The file of the worst of many devices: its name says what it is, "PHANToM, worst pose of its workspace", and its
/// uncertainty that it is trusted no more than `trust`.
[[nodiscard]] std::string worst_device_text(DeviceParameters device, std::string_view what, const Trust& trust);

}  // namespace zwidth::report
