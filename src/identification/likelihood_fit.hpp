#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// What is free in a fit by likelihood.
struct LikelihoodFitOptions {
  std::vector<std::string> free = {};    ///< as ParameterFitOptions::free
  std::vector<std::string> locked = {};  ///< bodies held still, by name
  bool known = false;                    ///< the structure's numbers are the device's, its delay too
};

/// A device found by likelihood, and the range of its limit.
struct LikelihoodFit {
  DeviceParameters device;  ///< at the moment of the record that the limit is of (limit_moment())
  double stiffness = 0.0;   ///< K_CR of the most likely device, nobody holding, no damper; N/m or N m/rad
  double lower = 0.0;       ///< least K_CR within 1.92 of the best log-likelihood, all rivals refitted
  double upper = 0.0;       ///< the largest
  bool settled = false;     ///< both ends were reached
};

/// The most likely device of a structure, with all that may explain its records beside it (add_rivals()), and the least and
/// the largest critical stiffness that the records allow. A linear fit of the response is the start; segments of half a
/// second with the record's own states find what is near, then the records whole under the noise of their own residuals.
///
/// Nothing where no start can be played or the found device has no limit. Throws Error as frequency_response() and
/// fit_parameters() do.
/// Source: theory, section 10; Venzon & Moolgavkar 1988.
[[nodiscard]] std::optional<LikelihoodFit> fit_by_likelihood(std::span<const Recording> recordings,
                                                             const Device& structure,
                                                             const LikelihoodFitOptions& options);

}  // namespace zwidth::internal
