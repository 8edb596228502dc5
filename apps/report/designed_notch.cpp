#include "report/designed_notch.hpp"

#include <utility>

namespace zwidth::report {

DesignedNotch designed_notch(const Device& device, const NotchOptions& options) {
  NotchDesign design = design_notch(device, options);
  AnalysedDevice without = design.state_without
                               ? AnalysedDevice{design.state_without->device, design.state_without->analysis}
                               : analysed_device(device, {.any_user = false, .draws = 0});
  std::optional<AnalysedDevice> with;
  if (design.state_with) with = AnalysedDevice{design.state_with->device, design.state_with->analysis};
  return {options, std::move(design), std::move(without), std::move(with)};
}

}  // namespace zwidth::report
