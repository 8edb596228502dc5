#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "design/sensitivities/design_parameter.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// P(e^{j angle}) of a device, without the filters of its wall, and its derivatives.
struct PlantSensitivity {
  std::complex<double> value;
  std::complex<double> by_angle;
  std::vector<std::complex<double>> by_parameter;  // at a fixed angle; 0 for those of the wall
};

/// In state space, P = C (delta I - Phi)^-1 (Gamma1 + Gamma2 z^-1) z^-l (discrete_state_space.hpp): with
/// x = (delta I - Phi)^-1 Gamma and y the same of C,
///
///     dP = y^T (dPhi x + dGamma) z^-l,    d exp(M t) = L(M t, t dM),    <W, L(A, E)> = <L(A^T, W), E>
///
/// so that one Frechet derivative per exponential gives the slopes to all entries of M = [A B; 0 0], whatever their
/// number. `reference` is P from the modal form, which keeps more digits: where the two differ, or without one, the
/// slopes are computed in long double. 0 <= angle <= pi (0 only with a finite static response).
[[nodiscard]] PlantSensitivity plant_sensitivity(const Device& device, double angle,
                                                 std::span<const DesignParameter> parameters,
                                                 std::optional<std::complex<double>> reference = std::nullopt);

}  // namespace zwidth::internal
