#pragma once

#include <optional>
#include <vector>

#include "identification/model/added_rival.hpp"
#include "identification/model/number.hpp"
#include "identification/response_fit.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What is fitted, and from where.
struct ResponseStart {
  DeviceParameters device;
  std::vector<Number> numbers;
  std::optional<Uncertainty> given = {};  ///< a prior of these numbers
  std::vector<AddedRival> rivals = {};    ///< whose numbers were not asked for
};

/// The numbers that show in the response, those of linear rivals among them, from where the initial fit ends. Throws Error as
/// fit_parameters() does.
[[nodiscard]] ResponseStart start_of_response(const ResponseFitSetting& setting);

/// Those that limits are fitted with, each with what is believed of it. Throws Error (invalid_argument) for an unknown key.
[[nodiscard]] ResponseStart start_of_limits(const ResponseFitSetting& setting);

}  // namespace zwidth::internal
