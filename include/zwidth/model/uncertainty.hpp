#pragma once

#include <optional>
#include <string>
#include <vector>

namespace zwidth {

/// How well some parameters of a device are known: their joint normal distribution around the device's values.
///
/// In the device file:  [uncertainty]  parameters = ["link.0.stiffness", ...]  covariance = [[...], ...]
///                     warning = "..."  (optional)
struct Uncertainty {
  std::vector<std::string> parameters;  ///< keys as in model/parameter.hpp, each once
  /// Symmetric positive semidefinite, in the products of the parameters' units; row by row.
  std::vector<std::vector<double>> covariance;
  std::string warning{};  ///< why the values or their covariance are not to be trusted; empty: nothing is known
};

}  // namespace zwidth
