#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/trust.hpp"

namespace zwidth {

/// How well some parameters of a device are known: their joint normal distribution around the device's values, and
/// whether the values are to be trusted at all.
///
/// In the device file:  [uncertainty]  parameters = ["link.0.stiffness", ...]  covariance = [[...], ...]
///                     verdict = "doubtful" | "refused"   warning = "..."   reasons = ["...", ...]
///                     assumed = ["body.motor.mass", ...]
/// Parameters and covariance may be left out where there is a warning, reasons, a verdict or something assumed.
struct Uncertainty {
  std::vector<std::string> parameters;  ///< keys as in model/parameter.hpp, each once
  /// Symmetric positive semidefinite, in the products of the parameters' units; row by row.
  std::vector<std::vector<double>> covariance;
  std::string warning{};  ///< why the values or their covariance are not to be trusted; empty: nothing is known
  /// What the warning and the reasons amount to; with either of them `sound` counts as `doubtful`.
  Trust::Verdict verdict = Trust::Verdict::sound;
  std::vector<std::string> reasons{};  ///< further ones, each with its remedy
  /// Keys of values that nobody has measured or stated, only assumed to begin with, each once; with any, `sound` counts
  /// as `doubtful`.
  std::vector<std::string> assumed{};
};

}  // namespace zwidth
