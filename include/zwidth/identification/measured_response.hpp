#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/measured_stiffness.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// A measured response and the critical stiffness that it shows without any model.
struct MeasuredResponse {
  std::string source;                          ///< the recording's name
  FrequencyResponse response;                  ///< its remarks moved to the ones below
  std::optional<MeasuredStiffness> stiffness;  ///< absent for a continuous response and for a single line
  std::vector<Remark> remarks;                 ///< all: of reading, of the signals, of the estimate, of the stiffness
  /// Of the critical stiffness, which is that of the bare loop (no virtual damper): refused unless it is found.
  Trust trust;
};

/// Checks what the options say by themselves; whether a record can meet them shows with the record.
[[nodiscard]] std::optional<OptionProblem> find_problem(const FrequencyResponseOptions& options);

/// The response of a recording, judged.
///
/// Two channels: the commanded force, and the motion that options.output names; both in SI units.
/// Throws Error (invalid_argument) for other recordings, where find_problem(options) finds one, and as the
/// frequency_response() of samples does.
[[nodiscard]] MeasuredResponse frequency_response(const Recording& recording,
                                                  const FrequencyResponseOptions& options = {},
                                                  const Progress& progress = {});

/// A response that was measured elsewhere (a table), judged. `remarks` are those made on the way to it.
[[nodiscard]] MeasuredResponse judged_response(std::string source, FrequencyResponse response,
                                               std::vector<Remark> remarks = {});

/// One line of a response by magnitude and phase. Bounds are those of 95 % confidence; absent where the noise is not
/// known, or leaves them open.
struct ResponseLine {
  double frequency = 0.0;  ///< rad/s
  double magnitude = 0.0;
  std::optional<double> magnitude_lower;
  std::optional<double> magnitude_upper;
  double phase = 0.0;  ///< rad, unwrapped from the lowest line, where it lies in (-3 pi/2, pi/2]
  std::optional<double> phase_lower;
  std::optional<double> phase_upper;
  double coherence = 0.0;
};

[[nodiscard]] std::vector<ResponseLine> response_lines(const FrequencyResponse& response);

}  // namespace zwidth
