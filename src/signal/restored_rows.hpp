#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "signal/row_grid.hpp"

namespace zwidth::internal {

/// Signals at equal steps, of rows some of which were lost or sampled off their time.
///
/// A lost row is interpolated between the rows around it, as a signal of limited band is (kriging with the covariance
/// sin(B t)/(B t)). Force and motion by the same weights: what these get wrong is the same factor of both spectra, and
/// cancels in the response. Band and weights are those that tell best what rows that are there hold; where they do not
/// tell the first signal, the force, the longest stretch without such a gap is all that is used.
/// Rows that were sampled off their time: the motion is interpolated at equal steps, the force, held from row to row, is
/// averaged over each, which leaves its effect on a mass as it was.
struct RestoredRows {
  std::vector<std::vector<double>> signals;  ///< of one size
  double period = 0.0;                       ///< s
  double start = 0.0;                        ///< s, time of the first

  // What was found, in the whole record.
  std::size_t lost = 0;         ///< rows
  std::size_t gaps = 0;         ///< they were lost in
  std::size_t first_gap = 0;    ///< row before it
  std::size_t longest_gap = 0;  ///< rows
  std::size_t filled = 0;       ///< of the lost ones, interpolated
  double filling_error = 0.0;   ///< rms that this adds to the first signal, relative to its own
  std::size_t first_row = 0;    ///< of those that are used
  std::size_t used_rows = 0;
  enum class Jitter { none, of_stamps, of_rows, unknown } jitter = Jitter::none;  ///< what was off its time
  double largest_jitter = 0.0;                                                    ///< periods
  double jitter_rms = 0.0;                                                        ///< periods
};

/// Of times that rise and signals of as many samples. The first signal is held from row to row where there are several.
[[nodiscard]] RestoredRows restored_rows(std::span<const double> times, const RowGrid& grid,
                                         std::span<const std::span<const double>> signals);

/// A signal that is held from each time to the next, averaged over `count` steps of `period` from `start` on. What it does
/// to a mass is left as it was: its integral in each step, and the moment in time about the step's middle, by its two
/// neighbours.
[[nodiscard]] std::vector<double> averaged_hold(std::span<const double> times, std::span<const double> signal,
                                                double start, double period, std::size_t count);

}  // namespace zwidth::internal
