#pragma once

#include <optional>
#include <span>
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

/// How a device's response depends on the force: a linear one's does not. Between the records of least and greatest
/// force on each line.
struct AmplitudeDependence {
  double difference = 0.0;        ///< of the response, relative; median of the lines on which it exceeds the noise
  double force_ratio = 1.0;       ///< greatest over least force, median
  std::size_t lines = 0;          ///< on which it exceeds the noise
  bool grows_with_force = false;  ///< as dry friction makes it, which holds a weak force more
  /// N or N m, that makes such a difference, where it grows with the force and stands out from the noise.
  std::optional<double> friction = {};
  std::optional<double> friction_deviation = {};  ///< one standard deviation of it, by the noise
};

/// A measured response and the critical stiffness that it shows without any model.
struct MeasuredResponse {
  std::string source;                          ///< the recording's name
  FrequencyResponse response;                  ///< its remarks moved to the ones below
  std::optional<MeasuredStiffness> stiffness;  ///< absent for a continuous response and for a single line
  std::vector<Remark> remarks;                 ///< all: of reading, of the signals, of the estimate, of the stiffness
  /// Of the critical stiffness, which is that of the bare loop (no virtual damper): refused unless it is found.
  Trust trust;
  std::string force_unit =
      {};  ///< in which the force is, by its column's name (Channel::base_unit, or unit); empty: none stated
  std::string length_unit = {};                        ///< of the position, "m" or "rad", by that of the motion
  std::optional<AmplitudeDependence> dependence = {};  ///< absent for one record, and where the records agree
};

/// Checks the names of units that a user gives a response; empty: none. A unit has at most 24 characters, on one line, and is no
/// other than the one that the column's name states. The members are named as MeasuredResponse's.
[[nodiscard]] std::optional<OptionProblem> find_problem(const std::string& force_unit, const std::string& length_unit,
                                                        const MeasuredResponse& measured);

/// Checks what the options say by themselves; whether a record can meet them shows with the record.
[[nodiscard]] std::optional<OptionProblem> find_problem(const FrequencyResponseOptions& options);

/// The response of a recording, judged.
///
/// Two channels: the commanded force, and the motion that options.output names; both in SI units.
/// Sound: the interval of the critical stiffness is within a factor of 1.5 and nothing contradicts. The interval reaches down to
/// the stiffness without as much dry friction as the record may hold. Where a record does not show friction, that is a note.
/// Segments whose length is not given are as long as the critical stiffness needs.
/// Throws Error (invalid_argument) for other recordings, where find_problem(options) finds one, and as the
/// frequency_response() of samples does.
[[nodiscard]] MeasuredResponse frequency_response(const Recording& recording,
                                                  const FrequencyResponseOptions& options = {},
                                                  const Progress& progress = {});

/// The response of one device from several recordings of it, pooled and judged: two channels each as above, each at its
/// own rate. The response is that of the first one's sampling period; lengths in samples of the options are its too.
///
/// Lines that several hold are averaged, weighted by the power of their force; the others stand side by side (a sine
/// per recording makes a line each). Recordings that differ by more than their noise are said to, with the size; the
/// trust is doubtful where that moves the critical stiffness beyond its interval, or may. Throws Error as for one
/// recording, naming it by its source; for the same samples twice.
[[nodiscard]] MeasuredResponse frequency_response(std::span<const Recording> recordings,
                                                  const FrequencyResponseOptions& options = {},
                                                  const Progress& progress = {});

/// A response that was measured elsewhere (a table), judged by its interval, and as far as it says of itself that it may be
/// trusted. It does not show dry friction: a note. `remarks` are those made on the way to it.
[[nodiscard]] MeasuredResponse judged_response(std::string source, FrequencyResponse response,
                                               std::vector<Remark> remarks = {});

/// One line of a response by magnitude and phase. Bounds are those of 95 % confidence; absent where the noise is not
/// known, or leaves them open.
struct ResponseLine {
  double frequency = 0.0;                 ///< rad/s
  double magnitude = 0.0;                 ///< of P, m/N or rad/(N m)
  std::optional<double> magnitude_lower;  ///< of its 95 % interval
  std::optional<double> magnitude_upper;  ///< of its 95 % interval
  double phase = 0.0;                     ///< rad, unwrapped from the lowest line, where it lies in (-3 pi/2, pi/2]
  std::optional<double> phase_lower;      ///< rad, of its 95 % interval
  std::optional<double> phase_upper;      ///< rad, of its 95 % interval
  double coherence = 0.0;                 ///< 0 to 1
};

/// The response with its 95 % intervals, line by line.
[[nodiscard]] std::vector<ResponseLine> response_lines(const FrequencyResponse& response);

}  // namespace zwidth
