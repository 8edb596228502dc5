#pragma once

#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {

/// A frequency at which the loop gain |C P| is 1.
struct GainCrossover {
  double frequency = 0.0;     ///< rad/s
  double phase_margin = 0.0;  ///< rad, in (-pi, pi]: angle of C P plus pi
};

/// How far a given wall is from instability.
struct WallMargins {
  double stiffness = 0.0;
  double damping = 0.0;
  bool stable = false;
  std::optional<double> gain_margin;        ///< least factor > 1 on the whole wall that destabilises; absent: none does
  std::optional<double> lower_gain_margin;  ///< largest factor in (0, 1) that destabilises; absent: none does
  std::optional<double> phase_margin;       ///< rad; smallest of all gain crossovers; absent without one or if unstable
  std::optional<double> delay_margin;       ///< s; min over all gain crossovers of phase/frequency; absent likewise
  double spectral_radius = 0.0;             ///< largest closed-loop |z|
  std::vector<GainCrossover> gain_crossovers;  ///< all, by rising frequency
};

/// Judges the wall C(z) = K + B v(z) closed around the plant.
///
/// Margins are absent when the loop is unstable. The delay margin treats the added delay as e^{-jw tau} on the sampled
/// loop: exact for whole samples, within the aliases (of order (w T / 2 pi)^2 relative) for fractions.
/// Throws Error (invalid_argument) when wall.stiffness is absent or a value is outside its domain.
[[nodiscard]] WallMargins wall_margins(const SampledPlant& plant, const Wall& wall);

/// Gain, phase and delay margins of a continuous loop L(s) under unit negative feedback, by the same complete search
/// after the bilinear map. Fields as above; spectral_radius is absent (0), the frequencies are continuous ones.
[[nodiscard]] WallMargins continuous_margins(const TransferFunction& loop);

}  // namespace zwidth
