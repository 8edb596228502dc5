#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "zwidth/progress.hpp"
#include "zwidth/signal/frequency_response.hpp"
#include "zwidth/signal/window.hpp"

namespace zwidth {

/// Which noise an estimate tolerates.
enum class ResponseEstimator {
  h1,  ///< S_fx / S_ff: noise on the position only; biased low by noise on the force
  h2,  ///< S_xx / S_xf: noise on the force only
};
/// What a sensor senses.
enum class OutputQuantity { position, velocity, acceleration };

/// How a frequency response is estimated from a recording.
struct FrequencyResponseOptions {
  OutputQuantity output = OutputQuantity::position;     ///< what was sensed
  ResponseEstimator estimator = ResponseEstimator::h1;  ///< which noise it tolerates
  // Welch
  Window window = Window::hann;               ///< of each segment of an aperiodic signal
  std::optional<std::size_t> segment_length;  ///< samples; chosen from the record when absent
  /// Of a segment, in [0, 1). Three quarters of Hann segments weigh every instant alike, which a sweep needs: it passes
  /// each frequency once.
  double overlap = 0.75;
  /// Periodic: the average over periods, with the noise measured from their scatter. See excitation_of().
  enum class Excitation { detect, periodic, aperiodic } excitation = Excitation::detect;  ///< detect: as recorded
  std::optional<std::size_t> period;  ///< samples; with Excitation::periodic, detected when absent
  std::size_t skip_periods = 0;       ///< leading periods in which the transient dies out; 0: those are found
  bool detrend = true;                ///< remove mean and drift before the transform
  /// Of an aperiodic record: whether the device was at rest, without a force, before it. Absent: as the record looks.
  std::optional<bool> begins_at_rest;
  /// Keep the lines that the force excites only where an aperiodic record begins or ends. What the device answers there is
  /// cut off, or was before: for what is left of a motion when a model's is taken off.
  bool lines_at_ends = false;
  std::optional<double> lowest;   ///< rad/s; points outside are left out
  std::optional<double> highest;  ///< rad/s; absent: as far as the excitation goes
  /// rad/s, all that the force excites where that is known: only these are estimated, whatever the record's length.
  /// Empty: found by their power.
  std::vector<double> lines;
};

/// What `detect` asks for: periodic where a period is given, aperiodic where a segment's length is; else the force
/// decides. Of recordings (identification/measured_response.hpp); the function of samples below takes options as they are.
[[nodiscard]] FrequencyResponseOptions::Excitation excitation_of(const FrequencyResponseOptions& options);

/// The response from force to position, line by line, with its noise.
///
/// Aperiodic (Welch), over segments k:  H1 = sum conj(F_k) X_k / sum |F_k|^2,  H2 = sum |X_k|^2 / sum conj(X_k) F_k,
/// coherence g^2 = |S_fx|^2 / (S_ff S_xx), variance = |H|^2 (1 - g^2) / (g^2 n), n the effective number of averages.
/// Periodic, over whole periods p: H = mean X / mean F at the lines that F excites, variance from the scatter of
/// X_p - H F_p over the periods (no leakage, no bias).
/// A force that is one sine, and lines that are given: their amplitudes by least squares in blocks p of the record, and
/// from them the same. Lines that are found exceed the noise that the scatter of the force shows around them.
/// A velocity v is turned into position by 1/(jw) and an acceleration by -1/w^2: an approximation under a held force,
/// too large by about (wT)^2/12 and twice that; said in the remarks.
/// Requires equally many finite samples, at least 16; `sampling_period` > 0. Throws Error (invalid_argument) otherwise,
/// for a constant force, and for options that the record cannot meet (period longer than half the record, ...).
/// Source: Welch 1967; Bendat & Piersol, Random Data, ch. 6 and 9; Pintelon & Schoukens, System Identification, ch. 2.
[[nodiscard]] FrequencyResponse frequency_response(std::span<const double> force, std::span<const double> output,
                                                   double sampling_period, const FrequencyResponseOptions& options = {},
                                                   const Progress& progress = {});

/// Radius of the disc around the point's value that holds the true one with 95 %: from the F distribution with 2 and
/// 2 averages - 2 degrees of freedom (the normal limit when averages are unknown). Infinity below two averages, and
/// where neither averages nor variance are known.
[[nodiscard]] double confidence_radius(const ResponsePoint& point, double averages);

}  // namespace zwidth
