#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::report {

/// A response that can be drawn: value(w) e^{-jw delay}. The delay is kept apart so that the unwrapped phase needs no
/// sample per turn.
struct DrawnResponse {
  std::function<std::complex<double>(double)> value;
  double delay = 0.0;       ///< s, >= 0
  double loop_delay = 0.0;  ///< s; of a loop closed inside value, which ripples once per turn of that delay
};

/// The continuous response, with a delay if any.
[[nodiscard]] DrawnResponse drawn_response(ModalForm form, double delay = 0.0);

/// The sampled response P with the virtual damper closed around it, P / (1 + B v P); valid up to pi/T.
///
/// Its negative-real values are those at which -1/K lies on it: the crossovers of critical_stiffness().
[[nodiscard]] DrawnResponse drawn_response(FilteredPlant plant, VirtualDamper damper = {});

struct FrequencyRange {
  double from = 0.0;  ///< rad/s, > 0
  double to = 0.0;    ///< rad/s, > from
};

/// The range that a figure shows unless told otherwise: from a power of ten below every event (crossover, mode) and
/// below pi/(1000 T), up to Nyquist.
[[nodiscard]] FrequencyRange default_range(double period, std::span<const double> events);

/// Frequencies at which a polyline through the responses is true to the eye: `points` per equal ratio, then halved
/// wherever magnitude or phase bends, so that the peaks of resonances and antiresonances are met.
///
/// `modes` are frequencies to start from besides the grid, since a light mode can hide between two grid points; those
/// above Nyquist are met again at their aliases when `period` > 0.
[[nodiscard]] std::vector<double> bode_frequencies(std::span<const DrawnResponse> responses, FrequencyRange range,
                                                   std::span<const Mode> modes, double period, std::size_t points);

struct BodePoint {
  double frequency = 0.0;     ///< rad/s
  double magnitude_db = 0.0;  ///< 20 log10 |.|
  double phase_deg = 0.0;     ///< unwrapped from the lowest frequency, where it lies in (-270, 90]
};

/// Magnitude and unwrapped phase at rising `frequencies`.
[[nodiscard]] std::vector<BodePoint> bode_points(const DrawnResponse& response, std::span<const double> frequencies);

}  // namespace zwidth::report
