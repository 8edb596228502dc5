#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "zwidth/progress.hpp"
#include "zwidth/signal/window.hpp"

namespace zwidth::internal {

/// How a record is cut into windowed, overlapping segments.
struct Segments {
  std::size_t length = 0;  ///< samples
  std::size_t step = 0;    ///< from the start of one to that of the next
  std::size_t count = 0;
  std::vector<double> window;
  double averages = 0.0;  ///< independent ones that they are worth
};

/// Requires 1 <= length <= samples and 0 <= overlap < 1.
[[nodiscard]] Segments segments_of(std::size_t samples, std::size_t length, Window window, double overlap);

/// Sums over the segments, by line 0 .. length / 2: |F|^2, |X|^2 and conj(F) X, with a common factor that is left out.
/// Line 0 stays zero.
struct AveragedSpectra {
  std::vector<double> ff;
  std::vector<double> xx;
  std::vector<double> fx_real;
  std::vector<double> fx_imag;
  double output_scale = 1.0;  ///< what the output was multiplied by, to be as large as the force
};

/// Differenced: s[i + 1] - s[i] of both signals (one sample fewer), which leaves their ratio of spectra as it is and
/// removes drift.
enum class SignalForm { as_recorded, differenced };

/// Requires signals of equal size that the segments fit into.
[[nodiscard]] AveragedSpectra averaged_spectra(std::span<const double> force, std::span<const double> output,
                                               const Segments& segments, SignalForm form,
                                               const Progress& progress = {});

}  // namespace zwidth::internal
