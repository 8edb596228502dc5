#include "report/designed_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "report/text/quantity.hpp"

namespace zwidth::report {

DesignedDevice designed_device(Device device) {
  AnalysedDevice analysed = analysed_device(std::move(device), {.draws = 0});
  DesignedDevice designed{std::move(analysed), {}, {}, std::nullopt};
  const Device& own = designed.analysed.device;
  designed.sensitivities = stiffness_sensitivities(own, designed.analysed.analysis.critical);
  if (designed.analysed.analysis.any_user)
    designed.any_user = any_user_sensitivities(own, *designed.analysed.analysis.any_user);
  if (own.bodies().size() <= most_bodies_for_branch_switches) designed.branch_switches = branch_switches(own);
  return designed;
}

std::string parameter_text(const std::string& key, double value, Motion motion) {
  const std::string unit = parameter_unit(key, motion);
  if (unit.empty()) return number(value);
  // Prefixes with units of one word only: no "mkg", no "mN s/m".
  return unit == "s" || unit == "Hz" || key.ends_with(".stiffness") ? quantity(value, unit)
                                                                    : fmt::format("{} {}", number(value), unit);
}

const Sensitivity* find_sensitivity(const std::vector<Sensitivity>& sensitivities, const std::string& key) {
  const auto found = std::ranges::find(sensitivities, key, &Sensitivity::key);
  return found == sensitivities.end() ? nullptr : &*found;
}

}  // namespace zwidth::report
