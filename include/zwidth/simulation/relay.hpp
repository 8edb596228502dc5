#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/simulation/relay_prediction.hpp"
#include "zwidth/simulation/relay_trials.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The device with its loop's delay longer by `added` s >= 0, as section V of Díaz & Gil varies it; or what is wrong.
[[nodiscard]] tl::expected<Device, DeviceProblem> with_added_delay(const Device& device, double added);

/// How a recorded relay experiment is read.
struct RelayRecordOptions {
  std::optional<Device> device;    ///< that was recorded, with the whole delay: to compare with; may be absent
  Motion motion = Motion::linear;  ///< of the units, without a device
  double hysteresis = 0.0;         ///< of the relay that was used, m or rad; >= 0; for the predictions
  RelayAnalysisOptions analysis;   ///< of the oscillation
};

/// The first member outside its domain; `sampling_period` is the record's: the device's must agree within 1 %.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RelayRecordOptions& options, double sampling_period);

/// Means over the trials that oscillate.
struct RelayMean {
  std::size_t trials = 0;          ///< how many were read
  double frequency = 0.0;          ///< rad/s
  double stiffness = 0.0;          ///< geometric: the mean of the decibels
  double amplitude = 0.0;          ///< m or rad, of the position's first harmonic
  double lowest_frequency = 0.0;   ///< of a trial, rad/s
  double highest_frequency = 0.0;  ///< rad/s
};

/// Nothing where no trial oscillates. The mean of trials at different oscillations is no number of the device:
/// RelayResult leaves it out.
[[nodiscard]] std::optional<RelayMean> relay_mean(const std::vector<RelayTrial>& trials);

/// What the mean says of the stiffest stable wall of linear theory.
enum class LimitReading {
  none,          ///< no device, no oscillation, no finite limit, or trials that settle at different oscillations
  confirms,      ///< the same stiffness within 0.5 dB, at its frequency within 15 %
  coincides,     ///< the same stiffness at another frequency
  unsafe,        ///< more: a wall as stiff as that would be unstable
  too_cautious,  ///< less
};

/// A relay experiment, simulated or recorded, beside what theory expects of it.
struct RelayResult {
  /// Where the motion comes from.
  enum class Source { simulation, recording };
  Source source = Source::simulation;  ///< of this result
  std::string recording;               ///< its name; empty for a simulation
  Motion motion = Motion::linear;      ///< which units its numbers have
  double sampling_period = 0.0;        ///< s
  Relay relay;                         ///< of a recording: half of the force's peak to peak
  std::vector<RelayTrial> trials;      ///< a recording is one
  /// Absent where no trial oscillates, and where they settle at different oscillations: of frequencies that differ by
  /// more than 15 %.
  std::optional<RelayMean> mean;
  std::optional<Device> device;                     ///< absent for a recording
  std::optional<double> friction_level;             ///< largest friction of the device over the relay's force
  std::optional<RelayPrediction> prediction;        ///< with a device
  LimitReading limit_reading = LimitReading::none;  ///< how it compares with the device's own limit
  /// What the experiment says about the wall's limit, a sentence or two each: whether it agrees with linear theory, what
  /// friction does to it, which other oscillations exist. Empty where no trial oscillates or without a device.
  std::vector<Finding> explanation;
  /// How far the mean is to be trusted as a limit for walls: as far as the device; doubtful where it differs from the
  /// limit of linear theory (unsafe, too_cautious) and where no device says what to expect; refused where there is no
  /// mean.
  Trust trust;
  std::vector<Remark> remarks;  ///< of the recording, and what of the device's [wall] is left out
};

/// Simulates the experiment on the device and sets it beside its predictions. The wall of the device is left out, but for
/// a damper that loop.damper runs apart: it runs on beside the relay. A
/// device that is refused makes no trials and no predictions: `trust` says why.
///
/// Throws Error (invalid_argument) with member and value where find_problem() finds one, (needs_bodies) for a start
/// offset of a transfer function. See relay_trials() for threads and progress.
[[nodiscard]] RelayResult relay(const Device& device, const RelayOptions& options, const Progress& progress = {});

/// Reads a recorded experiment: two channels, force and position. The relay's force is half of the force's peak to peak.
///
/// Throws Error (invalid_argument) for other channels, with member and value where find_problem() finds one, and for a
/// record that analyse_relay_record() refuses.
[[nodiscard]] RelayResult relay(Recording recording, const RelayRecordOptions& options = {},
                                const Progress& progress = {});

/// The same from several trials of one experiment, each a recording, all of one sampling period.
[[nodiscard]] RelayResult relay(std::vector<Recording> recordings, const RelayRecordOptions& options = {},
                                const Progress& progress = {});

}  // namespace zwidth
