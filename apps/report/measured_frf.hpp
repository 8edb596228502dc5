#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/measured_stiffness.hpp"
#include "zwidth/remark.hpp"

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
};

/// Judges the stiffness where that is possible, and collects its remarks after the given ones.
[[nodiscard]] MeasuredFrf measured_frf(std::string recording, FrfUnits units, FrequencyResponse response,
                                       std::vector<Remark> remarks);

/// One line as it is shown. Bounds are those of 95 % confidence; absent where the noise is not known, or leaves them
/// open.
struct FrfPoint {
  double frequency = 0.0;  ///< rad/s
  double magnitude = 0.0;
  std::optional<double> magnitude_lower;
  std::optional<double> magnitude_upper;
  double phase = 0.0;  ///< rad, unwrapped from the lowest line, where it lies in (-3 pi/2, pi/2]
  std::optional<double> phase_lower;
  std::optional<double> phase_upper;
  double coherence = 0.0;
};

[[nodiscard]] std::vector<FrfPoint> frf_points(const FrequencyResponse& response);

}  // namespace zwidth::report
