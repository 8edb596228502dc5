#pragma once

#include <optional>
#include <vector>

#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {

struct ResidualChecks {
  std::optional<double> missing_mode;  ///< rad/s
  std::vector<Remark> remarks;
};

/// What the residuals of a fit say about its structure: a mode that it lacks, or where it describes the data worst.
///
/// `points` are those of the fit. A missing mode is a resonance in the residual itself, c / (w0^2 - w^2 + j g w), that
/// explains most of it around its peak, away from the modes that the structure has (`modes`, rad/s).
[[nodiscard]] ResidualChecks check_residuals(const ParameterFit& fit, const std::vector<ResponsePoint>& points,
                                             const std::vector<double>& modes);

/// rad/s: where the residuals have a resonance away from these modes, which a structure has already.
[[nodiscard]] std::optional<double> missing_mode(const std::vector<std::complex<double>>& residuals,
                                                 const std::vector<ResponsePoint>& points,
                                                 const std::vector<double>& modes);

}  // namespace zwidth::internal
