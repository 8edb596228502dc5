#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// The values that one number takes, one for each of many devices.
struct ParameterValues {
  std::string key;             ///< as in model/parameter.hpp
  std::vector<double> values;  ///< SI units
};

/// What is wrong with the keys: one that is no number of the device, one twice, different counts of values, none.
[[nodiscard]] std::optional<DeviceProblem> find_problem(const Device& device, std::span<const ParameterValues> changes);

}  // namespace zwidth
