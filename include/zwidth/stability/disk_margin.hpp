#pragma once

#include <complex>
#include <optional>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {

/// How far gain and phase of a stable loop L may be wrong together: L times any complex factor f of a disk.
struct DiskMargin {
  double alpha = 0.0;  ///< the disk's size; > 0
  /// (2 + alpha)/(2 - alpha), greatest real factor of the disk; absent from alpha = 2 on: no factor above 1 destabilises.
  std::optional<double> gain_margin;
  std::optional<double> lower_gain_margin;  ///< (2 - alpha)/(2 + alpha), the least; absent from alpha = 2 on
  double phase_margin = 0.0;                ///< 2 atan(alpha/2), rad: the factors e^{+-j phase} on the disk's edge
  double frequency = 0.0;                   ///< rad/s, where the disk is used up
  /// f = -1/L there: the factor on the disk's edge with which a closed-loop pole lies at e^{jwT}; absent where L = 0.
  std::optional<std::complex<double>> worst_factor;
};

/// The symmetric disk margin of L(z) = C(z) P(z), C(z) = K + B v(z) as in Wall:
///
///     alpha = 2 / max over w of |S - T| = 2 / max |(1 - L)/(1 + L)|,  S = 1/(1 + L), T = L/(1 + L)
///
/// the largest disk f = (1 + d/2)/(1 - d/2), |d| < alpha, whose every factor f leaves the loop f L stable. Real f gives a
/// gain margin, |f| = 1 a phase margin, both at most those of LoopMargins: they hold together here.
/// The maximum is that of the whole band: where |(1 - L)/(1 + L)| exceeds 1 + 1e-9 times what is found has no solution on
/// the unit circle, by the same bounds on intervals that make the crossovers complete.
/// Absent where the loop is unstable. Throws Error as loop_margins(), and (did_not_converge) where the roots of the level
/// cannot be isolated.
/// Source: Seiler, Packard & Gahinet, An introduction to disk margins, IEEE Control Systems 40(5), 2020, eq. 8, 12, 14.
[[nodiscard]] std::optional<DiskMargin> disk_margin(const FilteredPlant& plant, const Wall& wall);

/// The same of the device's own wall. Throws Error (invalid_argument) when the device has no wall stiffness.
[[nodiscard]] std::optional<DiskMargin> disk_margin(const Device& device);

}  // namespace zwidth
