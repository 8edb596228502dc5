#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// How a device is identified from recordings.
struct IdentifyOptions {
  FrequencyResponseOptions response;  ///< how the response of a recording is estimated
  ParameterFitOptions fit;            ///< what is free and locked, and how it is fitted
  /// Whether the structure's numbers are those of the device (a device file), or of nobody (a named structure).
  enum class StructureValues { known, placeholders } structure_values = StructureValues::known;  ///< of the device
  /// Whether a delay that the record shows beyond the structure's is fitted too, or the structure's taken as it is.
  enum class LoopDelay {
    by_free,  ///< from_data where frees_all(fit.free); as_given where what is free is named
    from_data,
    as_given
  } loop_delay = LoopDelay::by_free;  ///< by what fit.free says
  /// What would make a sound answer doubtful is looked for beside it.
  enum class Scrutiny {
    thorough,  ///< friction by a fit in time too, which takes about as long as all else
    brief,     ///< friction in the rest of the linear fit only
    of_fit     ///< nor what else moves the device or limits it unseen: for identify_in_time(), which looks itself
  } scrutiny = Scrutiny::thorough;  ///< all of it
};

/// A structure for which there is no device file.
struct NamedStructure {
  DeviceParameters parameters;  ///< every number but the sampling period is 1 and stands for nothing
  IdentifyOptions::StructureValues values = IdentifyOptions::StructureValues::placeholders;  ///< to fit it with
};

/// How a named structure moves, and the loop to judge.
struct NamedStructureOptions {
  std::optional<Motion> motion = {};           ///< linear or rotary; absent: record_motion
  std::optional<double> sampling_period = {};  ///< s, of the loop; absent: record_period
  std::optional<double> record_period = {};    ///< s, of the recording; absent: it has none, as a table of a response
  std::optional<Motion> record_motion = {};    ///< stated_motion() of the recordings; absent: linear
};

/// The motion whose units the columns' names state, by Channel::base_unit: rotary of torques and angles. Nothing where they
/// state none, or both.
[[nodiscard]] std::optional<Motion> stated_motion(std::span<const Recording> recordings);

/// Whether a structure is called so: "rigid", "two-body" or "three-body".
[[nodiscard]] bool names_structure(std::string_view name);

/// Bodies in a row, each linked to the next, the first actuated and sensed, the last held:
///
///     "rigid": body      "two-body": motor, handle      "three-body": motor, body, handle
///
/// Nothing for any other name. Throws Error where find_problem(options) finds something.
[[nodiscard]] std::optional<NamedStructure> named_structure(std::string_view name,
                                                            const NamedStructureOptions& options);

/// A sampling period must be finite and above 0; one of the two must be given.
[[nodiscard]] std::optional<OptionProblem> find_problem(const NamedStructureOptions& options);

/// Checks both parts; members are named "response.overlap", "fit.robust_threshold", ...
[[nodiscard]] std::optional<OptionProblem> find_problem(const IdentifyOptions& options);

/// Coulomb friction that a record shows although the model has none.
struct ShownFriction {
  std::string body;        ///< on which it explains most
  double force = 0.0;      ///< N or N m
  double deviation = 0.0;  ///< one standard deviation of it
  /// K_CR of the device that a fit in time finds beside it. Absent where a linear fit found the friction: it does not know
  /// the damping that is left.
  std::optional<double> stiffness_beside = {};
};

/// The part of the wall that is closed around the device where a critical stiffness is given.
struct StiffnessBasis {
  double virtual_damping = 0.0;     ///< B, N s/m or N m s/rad; 0: the bare stiffness
  double velocity_filter_hz = 0.0;  ///< of the damper; 0: none
  std::size_t filters = 0;          ///< on the whole force
};

/// A device identified from a record, with its critical stiffness and how far that may be relied on.
struct Identification {
  std::string source;          ///< the recording's name
  FrequencyResponse response;  ///< as measured, less the leakage of its segments
  /// fit.device holds the uncertainty, with the verdict and the reasons below: its file keeps them.
  ParameterFit fit;
  Analysis analysis = {};                      ///< of fit.device, as analyze() gives it, without users
  StiffnessBasis basis = {};                   ///< of analysis.critical
  std::optional<ShownFriction> friction = {};  ///< absent where the record shows none
  std::optional<double> ignored_delay = {};    ///< s; that the record shows where another is given and not free
  std::vector<Remark> remarks = {};            ///< of reading, estimate, fit and judgement
  /// Of analysis.critical. The device's own (fit.device, analysis.trust) is no better: there, numbers that the data
  /// leave open count even where the response itself shows the critical stiffness.
  Trust trust = {};
};

/// Identifies a device from a record of force and motion: frequency_response(), fit_parameters(), without_leakage();
/// frees delay and lag where the record shows them; and judges.
///
/// Sound: the excited band holds the limiting crossover, the structure explains the response, the record shows no other
/// delay, every number that the limit hangs on is known or determined, no friction shows nor could pass for the damping, and the response itself shows no softer crossover. Doubtful where
/// one of these fails: where the crossover lies above the band, delay and lag enter the uncertainty whether or not they
/// were free. Refused: nothing is determined, half of the response is unexplained, or the sign of the motion is turned.
/// Requires two channels (force, motion), and what fit_parameters() does. Throws Error (invalid_argument) where
/// find_problem(options) finds one, and as its parts do.
[[nodiscard]] Identification identify(const Recording& recording, const Device& structure,
                                      const IdentifyOptions& options = {}, const Progress& progress = {});

/// The same from several recordings of one device, whose responses are pooled: frequency_response() of them says how.
[[nodiscard]] Identification identify(std::span<const Recording> recordings, const Device& structure,
                                      const IdentifyOptions& options = {}, const Progress& progress = {});

/// The same from a response that was measured elsewhere; friction and leakage do not show in one.
[[nodiscard]] Identification identify(const MeasuredResponse& measured, const Device& structure,
                                      const IdentifyOptions& options = {});

}  // namespace zwidth
