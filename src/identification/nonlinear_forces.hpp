#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// A force that hangs on the position or on the commanded force in no linear way: a sum of these, each of any size.
struct NonlinearForce {
  std::vector<std::vector<double>> terms;  ///< by sample
  bool is_of_command = false;              ///< acts where the actuator does; else where the position is sensed
  Finding finding;
};

/// How clearly a record shows such a force beside all that is linear.
struct NonlinearEvidence {
  double chi_squared = 0.0;  ///< less its degrees of freedom
  double share = 0.0;        ///< of the squares of what is left
};

/// What a linear device with dry friction does not do.
struct Nonlinearity {
  Finding finding;  ///< without its `source`: shown_by()
  NonlinearEvidence evidence;
};

/// The finding as what this source shows: "the record", or a recording by its name.
[[nodiscard]] Finding shown_by(std::string source, Finding finding);

/// The clearest of
///
///     cos and sin of 2 pi n x / range, n = 1..100 (each n by itself);   x^2 and x^3;   v |v|;   the part of the force
///     beyond 1/4, 1/2 and 3/4 of its largest
///
/// where chi-squared and the share explained are both beyond what records of linear devices show; nothing where none is.
[[nodiscard]] std::optional<Nonlinearity> clearest_nonlinearity(
    std::span<const double> position, std::span<const double> force, Motion motion,
    const std::function<NonlinearEvidence(const NonlinearForce&)>& evidence_of);

/// Orthonormal columns that span these less what the orthonormal linear ones have of them; fewer where nothing is left.
[[nodiscard]] Eigen::MatrixXd outside_linear_terms(Eigen::MatrixXd columns, const Eigen::MatrixXd& linear);

}  // namespace zwidth::internal
