#include "report/worst_device.hpp"

#include <fmt/format.h>

#include "zwidth/io/device_file.hpp"

namespace zwidth::report {

std::string worst_device_text(DeviceParameters device, std::string_view what, const Trust& trust) {
  const std::string name = device.name.empty() ? "(unnamed device)" : device.name;
  device.name = fmt::format("{}, {}", name, what).substr(0, max_name_size);
  if (!trust.sound()) {
    Uncertainty& uncertainty = device.uncertainty.emplace();
    uncertainty.verdict = trust.verdict;
    uncertainty.reasons = trust.reasons;
  }
  return write_device(device);
}

}  // namespace zwidth::report
