#pragma once

#include <optional>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// What one step q of the encoder does to the wall's force, N or N m; what a hand feels of it at rest or in slow motion.
struct ForcePerCount {
  double stiffness = 0.0;  ///< K q
  double damping = 0.0;    ///< B (1 - a) q / T, one sample long; a = exp(-2 pi f_c T), 0 without a velocity filter
  double largest = 0.0;    ///< greatest force after the step, through the wall's filters; without any, the sum of both
};

/// The greatest force after a step of q, per unit of K and of B; through filters their sum bounds that of both.
struct ForcePerCountRates {
  double per_stiffness = 0.0;  ///< m or rad; q without filters
  double per_damping = 0.0;    ///< m/s or rad/s; (1 - a) q / T without filters
};

/// The step response of the wall to q.
///
///     F(z) (K + B v(z)) q,  v and F as in Wall
///
/// `wall` without stiffness counts as K = 0. With filters the response is followed for at least 40 of the slowest
/// filter's time constants, at most a million samples.
/// Requires period > 0, resolution >= 0; throws Error (invalid_argument) where a filter has a problem.
/// Source: the backward difference of one count q over a period, (1 - z^-1)/T, through the filters.
[[nodiscard]] ForcePerCount force_per_count(const Wall& wall, double period, double resolution);

/// The same of the device's own wall; absent without sensor.resolution or wall.stiffness.
[[nodiscard]] std::optional<ForcePerCount> force_per_count(const Device& device);

/// Those rates, of the wall's velocity filter and filters.
[[nodiscard]] ForcePerCountRates force_per_count_rates(const Wall& wall, double period, double resolution);

}  // namespace zwidth
