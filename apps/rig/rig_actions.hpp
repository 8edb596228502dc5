#pragma once

#include <functional>
#include <optional>

#include "rig/driver.hpp"
#include "rig/flight_recorder.hpp"
#include "rig/rig_run.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/rig/results.hpp"

namespace zwidth::rig {

/// What the actions share. Each ends with zero force, whatever happens, and then hands over what the recorder holds.
struct RigOptions {
  SafetyLimits limits;
  /// Takes the record, and why the session ended: none where it came to its end, oscillation where a wall was taken away.
  std::function<void(const FlightRecorder&, StopReason)> record = {};
  Watcher watcher = {};  ///< of wall and limit
  /// The device is nudged before any wall or relay, and at the end of a check: a drive of wrong or unknown sign gets none.
  bool nudge = true;
};

struct MeasureOptions {
  ExcitationOptions excitation;  ///< a multisine
};

struct RelayTrialsOptions {
  Relay relay;
  std::size_t trials = 4;
  double duration = 20.0;  ///< s, of each
  /// Trials begin so that they find the limit's oscillation, and none at a faster crossover; else as those of relay().
  bool seek_limit = false;
  bool damper_on_drive = false;  ///< the drive closes the damper of the device's own loop beside the relay
  RelayAnalysisOptions analysis;
};

struct WallOptions {
  ControllerOptions controller;
  double duration = 10.0;        ///< s
  double impulse = 0.0;          ///< N or N m; 0: none
  bool damper_on_drive = false;  ///< the drive closes the damper of the device's own loop, the host the spring alone
};

struct LimitOptions {
  LimitSearchOptions search;
  double dwell = 0.0;            ///< s, of each trial
  double impulse = 0.0;          ///< N or N m
  bool damper_on_drive = false;  ///< as of a wall
};

/// The first that keeps the wall of a device from running so. One whose damper runs in a loop of its own
/// (has_damper_loop()) needs a damper on the drive, which needs such a loop, faster than the spring's, a damping, and a
/// wall on both sides: neither the host nor the drive would run another damper than the file's unasked.
[[nodiscard]] std::optional<OptionProblem> find_problem(const WallOptions& options, const Device& device);
[[nodiscard]] std::optional<OptionProblem> find_problem(const LimitOptions& options, const Device& device);
/// The same of a relay, which takes the place of the spring.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RelayTrialsOptions& options, const Device& device);

/// Zero force for a while: link, rate, latency; before that, the firmware's watchdog by silence.
[[nodiscard]] RigCheck check(const Device& device, Driver& driver, const RigOptions& options, double duration);
/// Excites, records, and estimates the response.
[[nodiscard]] RigMeasurement measure(const Device& device, Driver& driver, const RigOptions& options,
                                     const MeasureOptions& measurement, const Progress& progress);
/// The same, and fits the device's structure to it. Throws Error (invalid_argument) before anything moves for a structure
/// that identify() refuses.
[[nodiscard]] RigIdentification identify_on_rig(const Device& device, Driver& driver, const RigOptions& options,
                                                const MeasureOptions& measurement, const Progress& progress);
/// The relay experiment, without a damper of the host's. Between trials a soft wall brings the device back. Throws as
/// render_wall().
[[nodiscard]] RigRelay relay_on_rig(const Device& device, Driver& driver, const RigOptions& options,
                                    const RelayTrialsOptions& trials, const Progress& progress);
/// Renders a wall, until its end or until an oscillation grows. Throws Error (invalid_argument) where find_problem() finds
/// one, or the drive closes no damper.
[[nodiscard]] RigWall render_wall(const Device& device, Driver& driver, const RigOptions& options,
                                  const WallOptions& wall);
/// Raises the stiffness, impulse by impulse, until an oscillation grows. Between trials the softest wall of the search holds
/// the device. Throws as render_wall().
[[nodiscard]] RigLimit measure_limit(const Device& device, Driver& driver, const RigOptions& options,
                                     const LimitOptions& limit, const Progress& progress);

/// Defaults from what theory predicts of the device: the band about its limiting crossover, a force that moves it by about
/// a millimetre (milliradian), twenty steps of its encoder at least, and is three times its dry friction, at most a third of its force limit, or of a tighter one
/// that is given. Throw Error where the critical stiffness is refused, or not finite and not given.
[[nodiscard]] MeasureOptions default_measurement(const Device& device);
[[nodiscard]] double default_force(const Device& device, std::optional<double> force_limit = {});
[[nodiscard]] LimitOptions default_limit(const Device& device);

}  // namespace zwidth::rig
