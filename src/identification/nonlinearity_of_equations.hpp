#pragma once

#include <optional>
#include <span>

#include "identification/nonlinear_forces.hpp"
#include "zwidth/identification/inverse_dynamics.hpp"

namespace zwidth::internal {

/// Looks for forces that hang on the position in no linear way in what inverse dynamics leaves.
///
///     L[F](t - delay) = mass L[a] + viscous L[v] + coulomb L[sign v] + offset + spring L[x] + sum_j c_j L[g_j] + e
///
/// g_j: those of clearest_nonlinearity() that are no share of the command. Chi-squared of the c_j allows for errors that vary in size and are correlated in time,
/// as the fit's own intervals do; it holds with feedback and without. `fit` is of this record.
[[nodiscard]] std::optional<Nonlinearity> find_nonlinearity_of_equations(const RigidBodyFit& fit,
                                                                         std::span<const double> force,
                                                                         std::span<const double> position,
                                                                         double sampling_period, Motion motion);

}  // namespace zwidth::internal
