#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/model/added_rival.hpp"
#include "identification/model/number.hpp"
#include "identification/verdict/omnibus.hpp"
#include "zwidth/identification/measured_limit.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// What a device is found from where no motion is fitted (fit_motion()): lines of a response, measured limits, or both.
struct ResponseFitSetting {
  const Device& structure;
  const FrequencyResponse* response = nullptr;  ///< null: limits alone
  std::span<const MeasuredLimit> limits = {};
  std::vector<std::string> free = {};    ///< as ParameterFitOptions::free
  std::vector<std::string> locked = {};  ///< bodies held still while the response was measured, by name
  bool known = false;                    ///< the structure's numbers are the device's
  bool frees_lateness = false;           ///< delay and lag are looked for too
};

/// A device found by the likelihood of lines and limits, and the range of its limit.
struct ResponseFit {
  DeviceParameters device;
  std::vector<Number> numbers;  ///< of the fit, all of the device: linear rivals act as numbers of it
  Eigen::VectorXd x;            ///< a coordinate each
  Eigen::MatrixXd covariance;   ///< of x, by the normal matrix at the best
  Eigen::VectorXd slope;        ///< how log K_CR hangs on x
  double lower = 0.0;           ///< least K_CR within 1.92 of the best log-likelihood, no damper; N/m or N m/rad
  double value = 0.0;           ///< K_CR of the most likely device
  double upper = 0.0;           ///< the largest
  double last_change = 0.0;     ///< as FoundDevice::last_change
  std::vector<AddedRival> rivals = {};  ///< as ResponseStart::rivals
  /// Whether bands of neighbouring lines are off together by chance, and limits from what is fitted.
  Omnibus omnibus = {};
};

/// The most likely device of a structure, and the least and the largest critical stiffness that the data allow.
///
/// Of a response: fit_parameters() is the start; beside the numbers that are free those of linear rivals are fitted, a lag where
/// lateness is free, a spring to the ground at the held body; what the file of a known structure gives only within its [uncertainty] is as open as that.
/// What is not linear does not show. Neighbouring lines of a window share their noise: the
/// likelihood counts as so many fewer.
/// Of limits alone: named numbers are open, all others exact, but for those of the file's [uncertainty], which is the prior. Where
/// none is named, the numbers of the [uncertainty] are fitted; where the file has none, all that a response shows, each within 20 %.
///
/// Nothing where the data say nothing, where no start can be computed, or where the found device has no limit.
/// Throws Error as fit_parameters() does.
[[nodiscard]] std::optional<ResponseFit> fit_response(const ResponseFitSetting& setting);

}  // namespace zwidth::internal
