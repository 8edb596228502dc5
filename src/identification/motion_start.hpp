#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/model/motion_model.hpp"
#include "identification/model/rivals/catalogue.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/frequency_response.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// What is free where the motion is fitted.
struct FreeNumbers {
  std::vector<std::string> keys = {};    ///< as ParameterFitOptions::free
  std::vector<std::string> locked = {};  ///< bodies held still, by name
  bool lateness = false;                 ///< delay and lag are looked for
  bool is_start = false;                 ///< the structure's values are where the search begins
  bool is_known = false;                 ///< the structure is a device's, and no mere name
};

/// The records, what is fitted to them, and the linear device that the search begins at.
struct MotionStart {
  std::vector<std::vector<double>> positions = {};  ///< m or rad, about the mean of each record: no origin matters
  std::vector<ForceMotionRecord> records = {};
  std::vector<double> encoder_steps = {};  ///< m or rad, of each
  DeviceParameters device;
  ModelParts parts = {};
  std::vector<AddedRival> rivals = {};
  std::optional<DeviceParameters> known = {};  ///< the structure, where it is a device's
};

/// Deviation of a delay that is given, sampling periods: who states one has counted or measured it to a fiftieth of one.
inline constexpr double deviation_of_given_delay = 0.02;

/// The linear fit of the response, with all that may explain the records beside it. Throws Error as fit_parameters() does.
[[nodiscard]] MotionStart motion_start(std::span<const Recording> recordings, const FrequencyResponse& response,
                                       const Device& structure, const FreeNumbers& free);

}  // namespace zwidth::internal
