#pragma once

#include <complex>
#include <cstddef>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/recording_file.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// One line of a table of a frequency response, before anything is checked.
struct ResponseLine {
  double frequency = 0.0;      ///< rad/s; NaN, like the others, where the file has no number
  std::complex<double> value;  ///< not yet multiplied by options.scale
  double coherence = 1.0;
  std::size_t line = 0;  ///< of the file; 0 where it has none
};

/// The response of these lines, by rising frequency. Lines without a number and the one at frequency zero are left out
/// with a remark. Lines at one frequency are repeats: their mean, with the noise that their scatter shows.
/// Refused, with the line: a negative frequency, one above half the sampling rate, the same line twice, a
/// coherence outside [0, 1], a value that the scale makes infinite, fewer than two lines.
[[nodiscard]] tl::expected<FrequencyResponse, InputError> make_response(std::vector<ResponseLine> lines,
                                                                        const ResponseTableOptions& options,
                                                                        const std::string& source);

}  // namespace zwidth::internal
