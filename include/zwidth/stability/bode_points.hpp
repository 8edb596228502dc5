#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// A frequency response value(w) e^{-jw delay}. The delay is kept apart so that the unwrapped phase needs no sample per
/// turn.
struct DelayedResponse {
  /// The response without the delay, at w in rad/s.
  std::function<std::complex<double>(double)> value;
  double delay = 0.0;       ///< s, >= 0
  double loop_delay = 0.0;  ///< s; of a loop closed inside value, which ripples once per turn of that delay
};

/// The continuous response G, with a delay if any.
[[nodiscard]] DelayedResponse delayed_response(ModalForm form, double delay = 0.0);

/// The sampled response through the wall's filters, the virtual damper closed around it:
///
///     F P / (1 + B v F P)        valid up to pi/T
///
/// Its negative-real values are those at which -1/K lies on it: the crossovers of critical_stiffness().
[[nodiscard]] DelayedResponse delayed_response(FilteredPlant plant, VirtualDamper damper = {});

/// The frequencies that a response is asked for.
struct FrequencyRange {
  double from = 0.0;  ///< rad/s, > 0
  double to = 0.0;    ///< rad/s, > from
};

/// Frequencies at which a polyline through the responses is true to the eye, rising: `points` per equal ratio, then
/// halved wherever magnitude or phase bends, so that the peaks of resonances and antiresonances are met.
///
/// `modes` are frequencies to start from besides the grid, since a light mode can hide between two grid points; those
/// above Nyquist are met again at their aliases when `period` > 0. Poles of undamped modes and undamped zeros are left
/// out: a response there has no finite decibel. At most about 20 000.
[[nodiscard]] std::vector<double> bode_frequencies(std::span<const DelayedResponse> responses, FrequencyRange range,
                                                   std::span<const Mode> modes, double period, std::size_t points);

/// A response at one frequency.
struct BodePoint {
  double frequency = 0.0;     ///< rad/s
  double magnitude_db = 0.0;  ///< 20 log10 |.|
  double phase_deg = 0.0;     ///< unwrapped from the lowest frequency, where it lies in (-270, 90]
};

/// Magnitude and unwrapped phase at rising `frequencies`.
[[nodiscard]] std::vector<BodePoint> bode_points(const DelayedResponse& response, std::span<const double> frequencies);

}  // namespace zwidth
