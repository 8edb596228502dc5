#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/measured_response.hpp"

namespace zwidth::report {

/// Names of the units of a measured response.
struct FrfUnits {
  std::string force = "N";
  std::string position = "m";
  [[nodiscard]] std::string stiffness() const;   ///< "N/m", "N m/rad"
  [[nodiscard]] std::string compliance() const;  ///< "m/N", "rad/(N m)"
};

/// A measured response with what it says about the critical stiffness: the input of the text, JSON, CSV and figure.
struct MeasuredFrf {
  std::string recording;  ///< the file's name
  FrfUnits units;
  FrequencyResponse response;
  std::optional<MeasuredStiffness> stiffness;  ///< absent for a continuous response: hold and delay are not in it
  std::vector<Remark> remarks;                 ///< all: of the file, the signals, the estimate, the stiffness
  Trust trust = {};
};

[[nodiscard]] MeasuredFrf measured_frf(MeasuredResponse measured, FrfUnits units);

}  // namespace zwidth::report
