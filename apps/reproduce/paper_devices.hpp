#pragma once

#include <array>

#include "zwidth/model/device.hpp"

namespace zwidth::report {

// The devices of Díaz & Gil, "Influence of Internal Vibration Modes on the Stability of Haptic Rendering", the same as
// devices/lhifam*.toml: reproduce runs wherever the program is, with no files beside it.

/// Table I: LHIfAM, motor sensed, T = 1 ms.
[[nodiscard]] DeviceParameters paper_lhifam();

/// With the cable of Fig. 8. Its stiffness and damping are inferred from the crossover printed with Fig. 9 (set A); the
/// paper shows them in an image only.
[[nodiscard]] DeviceParameters paper_lhifam_reduced_pretension();

/// Eq. 2: all of it one rigid body.
[[nodiscard]] DeviceParameters paper_lhifam_rigid();

/// Section VI: the handle is sensed instead of the motor.
[[nodiscard]] DeviceParameters handle_sensed(DeviceParameters device);

[[nodiscard]] DeviceParameters with_delay(DeviceParameters device, double delay);

/// A trial of Table II: the relay experiment.
struct PaperTrial {
  double delay = 0.0;         ///< s
  double frequency_hz = 0.0;  ///< of the oscillation
  double margin_db = 0.0;     ///< dB re 1 N/m
};
inline constexpr std::size_t trials_per_delay = 4;

/// Table II, by rising delay, 0 to 8 ms, four trials each.
[[nodiscard]] const std::array<PaperTrial, 36>& paper_table_2();

}  // namespace zwidth::report
