#include "report/designed_device.hpp"

#include <fmt/format.h>

#include <utility>

#include "report/text/quantity.hpp"

namespace zwidth::report {

DesignedDevice designed_device(Device device) {
  Design answer = design(device);
  return {{std::move(device), std::move(answer.analysis)},
          std::move(answer.sensitivities),
          std::move(answer.any_user_sensitivities),
          std::move(answer.branch_switches)};
}

std::string parameter_text(const std::string& key, double value, Motion motion) {
  const std::string unit = parameter_unit(key, motion);
  if (unit.empty()) return number(value);
  // Prefixes with units of one word only: no "mkg", no "mN s/m".
  return unit == "s" || unit == "Hz" || key.ends_with(".stiffness") ? quantity(value, unit)
                                                                    : fmt::format("{} {}", number(value), unit);
}

}  // namespace zwidth::report
