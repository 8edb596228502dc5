#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/finding.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/remark.hpp"

namespace zwidth {

/// How an oscillation is read from a record.
struct RelayAnalysisOptions {
  /// Samples of each spectrum; 8192 at 1 kHz gives the lines of Table II of Díaz & Gil. >= 64
  std::size_t segment_length = 8192;
  /// Largest relative difference of the swing of a steady oscillation from its mean; in (0, 1)
  double steady_tolerance = 0.05;
};

/// The first member outside its domain.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RelayAnalysisOptions& options);

/// What a steady relay record says.
struct RelayReading {
  /// rad/s: the line where the averaged power spectra of force and position, each scaled to unit power, add up highest
  double frequency = 0.0;
  /// S_ff / |S_fx| there: the stiffness that the empirical transfer function reads off, N/m or N m/rad
  double stiffness = 0.0;
  double amplitude = 0.0;  ///< half of the position's mean peak to peak over a cycle, m or rad
  /// rad/s, from the mean length of the position's cycles: free of the spectral grid. Absent where the cycles are not
  /// those of `frequency` (another oscillation rides on it). Off by up to 0.3/N^2, relative, for N cycles.
  std::optional<double> cycle_frequency;
  double line_spacing = 0.0;       ///< rad/s, of the spectra
  std::size_t segments = 0;        ///< that were averaged
  std::size_t steady_from = 0;     ///< sample from which the record is steady
  std::size_t steady_samples = 0;  ///< samples analysed: all from there to the end
  /// Relative standard deviation of the swing from stretch to stretch of a few cycles.
  double scatter = 0.0;
  std::vector<Remark> remarks;  ///< fewer samples than a segment, drift, an oscillation that never becomes steady
};

/// Why a record holds no oscillation.
struct NoOscillation {
  Finding why;  ///< one line in words
};

/// Reads frequency and critical stiffness off a record of force and position, simulated or real.
///
/// The steady part begins where the swing (rms about a straight line, over stretches of four cycles, or an eighth of
/// the record) has come within the tolerance, or its own scatter, of its mean over the last half. Its spectra are those
/// of Hann segments, three quarters overlapping; a steady part shorter than a segment is one segment. Requires equally
/// many finite samples, sampling_period > 0 and options in their domain; throws Error (invalid_argument) otherwise.
/// Source: section V of Díaz & Gil (who print neither window nor overlap).
[[nodiscard]] tl::expected<RelayReading, NoOscillation> analyse_relay_record(std::span<const double> force,
                                                                             std::span<const double> position,
                                                                             double sampling_period,
                                                                             const RelayAnalysisOptions& options = {});

}  // namespace zwidth
