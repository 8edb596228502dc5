#include "report/designed_notch.hpp"

#include <cmath>
#include <utility>

namespace zwidth::report {

DesignedNotch designed_notch(const Device& device, const NotchOptions& options) {
  NotchDesign design = design_notch(device, options);
  DeviceParameters parameters = device.parameters();
  if (design.with > 0.0 && std::isfinite(design.with)) parameters.wall.stiffness = design.with;
  AnalysedDevice without = analysed_device(Device(parameters), {.draws = 0});
  std::optional<AnalysedDevice> with;
  if (design.notch) {
    parameters.wall.filters.push_back(*design.notch);
    with = analysed_device(Device(parameters), {.draws = 0});
  }
  return {options, std::move(design), std::move(without), std::move(with)};
}

}  // namespace zwidth::report
