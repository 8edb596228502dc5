#pragma once

#include <string>
#include <vector>

#include "report/analysed_device.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::report {

/// A device identified from a measured response, the input of every report on it.
struct IdentifiedDevice {
  std::string source;          ///< the recording's name
  FrequencyResponse response;  ///< as measured
  ParameterFit fit;
  AnalysedDevice analysed;      ///< the fitted device with its answer
  std::vector<Remark> remarks;  ///< of reading, estimate and fit
};

/// The unit of a parameter by its key, in the device or of a rigid body's fit: "kg", "N s/m", "N", "s".
[[nodiscard]] std::string_view unit_of_parameter(std::string_view key, Motion motion);

}  // namespace zwidth::report
