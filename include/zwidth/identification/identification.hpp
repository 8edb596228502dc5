#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/measured_limit.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/identification/measured_stiffness.hpp"
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
  ParameterFitOptions fit;            ///< what is free and locked; for `lines`, how it is fitted
  /// Whether the structure's numbers are those of the device (a device file), or of nobody (a named structure).
  enum class StructureValues { known, placeholders } structure_values = StructureValues::known;  ///< of the device
  /// Whether delay and lag are fitted too, or the structure's taken as they are.
  enum class LoopDelay {
    by_free,  ///< from_data where frees_all(fit.free); as_given where what is free is named
    from_data,
    as_given
  } loop_delay = LoopDelay::by_free;  ///< by what fit.free says
  /// What is fitted.
  enum class Method {
    motion,  ///< the recorded position itself, with all that may move the device beside its linear equations
    lines    ///< the lines of the response, of a linear device
  };
  /// Absent: motion, where recordings of force and position are given; else lines.
  std::optional<Method> method = {};
  double segment = 10.0;                   ///< s, for `motion`; each begins in a state of its own
  std::vector<MeasuredLimit> limits = {};  ///< walls at which the device was seen to oscillate
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

/// The motion whose units the columns' names state, by Channel::base_unit: rotary of torques and angles. Where they state
/// none, rotary of a column called torque beside one called angle or position. Nothing elsewhere.
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

/// Another explanation of a record, fitted beside the device.
struct RivalEstimate {
  std::string code;                          ///< "coulomb_friction", "drag", ...: stable
  std::string parameter;                     ///< its number: "friction.handle"
  std::string unit = {};                     ///< of value; empty: none
  double value = 0.0;                        ///< in the most likely fit
  std::optional<double> standard_deviation;  ///< absent where the data do not determine it
  double log_likelihood_gain = 0.0;          ///< of the best fit over one without the rival, to second order; >= 0
  /// K_CR over the rival's own 95 % interval, all else refitted, to first order. Within the answer's interval.
  std::optional<Interval> stiffness_interval = {};
};

/// A recording beside the motion of the fitted device.
struct FittedMotion {
  std::string source;                     ///< of the record: a file's name
  double sampling_period = 0.0;           ///< s
  double constant_force = 0.0;            ///< N or N m, beside the recorded one
  double constant_force_deviation = 0.0;  ///< one standard deviation
  double noise = 0.0;                     ///< m or rad, root mean square: what one sample has that those before do not
  double unexplained = 0.0;         ///< rms of recorded - fitted over the rms of the recorded motion about its mean
  std::vector<double> residuals{};  ///< recorded - fitted, by sample; 0 before the first segment
  std::vector<double> recorded{};   ///< position, m or rad, by sample
};

/// The part of the wall that is closed around the device where a critical stiffness is given.
struct StiffnessBasis {
  double virtual_damping = 0.0;     ///< B, N s/m or N m s/rad; 0: the bare stiffness
  double velocity_filter_hz = 0.0;  ///< of the damper; 0: none
  std::size_t filters = 0;          ///< on the whole force
};

/// A device identified from recordings or a response, with its critical stiffness and how far that may be relied on.
struct Identification {
  std::string source;                                                ///< the recording's name
  IdentifyOptions::Method method = IdentifyOptions::Method::motion;  ///< what was fitted
  FrequencyResponse response;                                        ///< as measured
  /// fit.device holds the uncertainty, with the verdict and the reasons below: its file keeps them. It is doubtful, too, where it has
  /// a body that the structure lacks (further_body_fitted): limits with a user hang on where that is. fit.fitted: its response.
  ParameterFit fit;
  std::vector<FittedMotion> motions = {};  ///< by recording; empty for lines
  std::vector<RivalEstimate> rivals = {};  ///< first what moves the limit most
  Analysis analysis = {};                  ///< of fit.device, without users; its interval covers all that is as likely
  StiffnessBasis basis = {};               ///< of analysis.critical
  std::vector<Remark> remarks = {};        ///< of reading, estimate, fit and judgement
  Trust trust = {};                        ///< of analysis.critical
};

/// Identifies a device from recordings of force and motion by maximum likelihood.
///
///     max over p, q, x_s   log L(recordings | device p, rivals q, states x_s) + log prior(q)
///
/// Rivals q: what may explain a record beside the linear device (friction, drag, drift, a lag, a spring ...), always part of the
/// fit. The interval of K_CR is its range over everything within 1.92 of the best log-likelihood (Venzon & Moolgavkar 1988).
/// Sound: the interval is within a factor of 1.5 and one omnibus test of what the best fit leaves holds. Doubtful: it is wider,
/// or something stands out. Refused: nothing is determined, or the data contradict each other.
///
/// Requires two channels (force, motion) in each recording, and what fit_parameters() does. Throws Error (invalid_argument) where
/// find_problem(options) finds one, and as its parts do.
[[nodiscard]] Identification identify(std::span<const Recording> recordings, const Device& structure,
                                      const IdentifyOptions& options = {}, const Progress& progress = {});

/// The same from one recording.
[[nodiscard]] Identification identify(const Recording& recording, const Device& structure,
                                      const IdentifyOptions& options = {}, const Progress& progress = {});

/// The same from a response that was measured elsewhere; what is not linear does not show in one.
[[nodiscard]] Identification identify(const MeasuredResponse& measured, const Device& structure,
                                      const IdentifyOptions& options = {});

/// From measured limits alone (options.limits), the structure's numbers being known within its uncertainty or by `fit.free`.
/// Throws Error (invalid_argument) where there is none.
[[nodiscard]] Identification identify_from_limits(const Device& structure, const IdentifyOptions& options);

/// What the fitted device renders with every holder: analyze() of it, trusted as the fit is, or as the device where that is less.
///
/// Without an interval: Identification::analysis has the one that covers the rivals too. Throws as analyze() does.
[[nodiscard]] Analysis analyze_fit(const Identification& identified);

}  // namespace zwidth
