#pragma once

#include <string>
#include <vector>

#include "report/analysed_device.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth::report {

/// A device identified from a measured response, the input of every report on it.
struct IdentifiedDevice {
  std::string source;          ///< the recording's name
  FrequencyResponse response;  ///< as measured
  ParameterFit fit;
  AnalysedDevice analysed;      ///< the fitted device with its answer
  std::vector<Remark> remarks;  ///< of reading, estimate, fit and judgement
  StiffnessBasis basis = {};
  Trust trust = {};
};

[[nodiscard]] IdentifiedDevice identified_device(Identification identified);

/// "the bare stiffness, no virtual damper", "with the wall's damper of 5 N s/m closed": what a K_CR is given with.
[[nodiscard]] std::string basis_text(const StiffnessBasis& basis, Motion motion);

/// The unit of a parameter by its key, in the device or of a rigid body's fit: "kg", "N s/m", "N", "s".
[[nodiscard]] std::string_view unit_of_parameter(std::string_view key, Motion motion);

}  // namespace zwidth::report
