#pragma once

#include <optional>
#include <vector>

#include "identification/model/number.hpp"
#include "identification/response_fit.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What is fitted, and from where.
struct ResponseStart {
  DeviceParameters device;
  std::vector<Number> numbers;
  std::optional<Uncertainty> given;  ///< a prior of these numbers
};

/// The numbers that show in the response, a lag and a spring to the ground among them; where a linear fit ends. Throws Error as
/// fit_parameters() does.
[[nodiscard]] ResponseStart start_of_response(const ResponseFitSetting& setting);

/// Those that limits are fitted with, each with what is believed of it. Throws Error (invalid_argument) for an unknown key.
[[nodiscard]] ResponseStart start_of_limits(const ResponseFitSetting& setting);

}  // namespace zwidth::internal
