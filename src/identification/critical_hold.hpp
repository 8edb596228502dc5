#pragma once

#include <optional>
#include <vector>

#include "identification/fit_solution.hpp"

namespace zwidth::internal {

/// The measured critical point as a point of the fit.
struct CriticalPoint {
  ResponsePoint point;
  double relative_deviation = 0.0;  ///< of the measurement there
  bool is_guess = false;            ///< the data do not prove that it is the critical one
  std::vector<Remark> remarks;      ///< what the measurement says against it
};

/// The critical point that the response shows; nothing where it is a table, where bodies are locked, or where the data
/// do not prove one.
[[nodiscard]] std::optional<CriticalPoint> measured_critical_point(const FrequencyResponse& response,
                                                                   const ParameterFitOptions& options);

/// Refits with the critical point weighing a hundred times all others together; nothing where there is no reason to,
/// where the fit is nowhere near it (the structure lacks what limits the wall), or where the others would suffer.
[[nodiscard]] std::optional<Solution> hold(const FitModel& model, const std::vector<ResponsePoint>& points,
                                           const Solution& free, const CriticalPoint& critical,
                                           double robust_threshold);

}  // namespace zwidth::internal
