#include "zwidth/model/parameter_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "zwidth/model/parameter.hpp"

namespace zwidth {

std::optional<DeviceProblem> find_problem(const Device& device, std::span<const ParameterValues> changes) {
  const std::vector<std::string> known = parameter_keys(device.parameters());
  std::vector<std::string> seen;
  for (const ParameterValues& each : changes) {
    std::string key = full_parameter_key(device.parameters(), each.key);
    if (std::ranges::find(known, key) == known.end()) {
      return DeviceProblem{each.key, "is no number of the device",
                           fmt::format("the numbers of this device are {}", fmt::join(known, ", "))};
    }
    if (std::ranges::find(seen, key) != seen.end()) return DeviceProblem{each.key, "is given twice", "once"};
    if (each.values.size() != changes.front().values.size()) {
      return DeviceProblem{each.key,
                           fmt::format("has {} values, {} has {}", each.values.size(), changes.front().key,
                                       changes.front().values.size()),
                           "equally many of every key"};
    }
    seen.push_back(std::move(key));
  }
  if (changes.empty()) return DeviceProblem{"", "no number is changed", "one key at least, with its values"};
  return std::nullopt;
}

}  // namespace zwidth
