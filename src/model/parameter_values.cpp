#include "zwidth/model/parameter_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "counted.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {

std::optional<DeviceProblem> find_problem(const Device& device, std::span<const ParameterValues> changes) {
  const std::vector<std::string> known = parameter_keys(device.parameters());
  std::vector<std::string> seen;
  for (const ParameterValues& each : changes) {
    std::string key = full_parameter_key(device.parameters(), each.key);
    if (std::ranges::find(known, key) == known.end()) {
      return device_problem(each.key, {.code = ProblemCode::no_number_of_device,
                                       .subjects = {{"numbers", fmt::format("{}", fmt::join(known, ", "))}}});
    }
    if (std::ranges::find(seen, key) != seen.end()) return device_problem(each.key, {.code = ProblemCode::given_twice});
    if (each.values.size() != changes.front().values.size()) {
      return device_problem(each.key, {.code = ProblemCode::values_of_two_lengths,
                                       .evidence = {internal::counted("values", each.values.size()),
                                                    internal::counted("others", changes.front().values.size())},
                                       .subjects = {{"other", changes.front().key}}});
    }
    seen.push_back(std::move(key));
  }
  if (changes.empty()) return device_problem("", {.code = ProblemCode::nothing_changed});
  return std::nullopt;
}

}  // namespace zwidth
