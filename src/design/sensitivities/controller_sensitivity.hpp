#pragma once

#include <complex>
#include <span>
#include <vector>

#include "design/sensitivities/design_parameter.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The filters of the wall at z = e^{j angle}, F = F_1 F_2 ..., and the derivatives of log F.
struct FilterSensitivity {
  std::complex<double> value = 1.0;
  std::complex<double> log_by_angle = 0.0;
  std::vector<std::complex<double>> log_by_parameter;  // at a fixed angle; 0 for all but the filters' and the period
};

/// By Tustin's rule prewarped at w, with u = s/w = j tan(angle/2) / tan(w T/2) and polynomials homogeneous in
/// (j sin(angle/2) / tan(w T/2), cos(angle/2)), which stay finite at Nyquist. F must not vanish at the angle.
[[nodiscard]] FilterSensitivity filter_sensitivity(const Device& device, double angle,
                                                   std::span<const DesignParameter> parameters);

/// The virtual damper at z = e^{j angle}: B v, and its derivatives.
struct DamperSensitivity {
  std::complex<double> value = 0.0;
  std::complex<double> by_angle = 0.0;
  std::vector<std::complex<double>> by_parameter;  // at a fixed angle; 0 for all but damping, filter and the period
};

/// v = (1 - a)/T (1 - z^-1)/(1 - a z^-1), a = exp(-2 pi f_c T), 0 without a velocity filter.
[[nodiscard]] DamperSensitivity damper_sensitivity(const Device& device, double angle,
                                                   std::span<const DesignParameter> parameters);

}  // namespace zwidth::internal
