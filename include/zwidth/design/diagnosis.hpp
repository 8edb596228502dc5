#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/design/wall_number.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/signal/recording.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// What may keep a device oscillating at its wall.
enum class OscillationCause {
  device,        ///< the loop of the device that nobody holds is unstable
  with_user,     ///< the loop with the device's own [operator] is, that without is not
  passive_user,  ///< some passive user's grasp makes it unstable
  quantisation,  ///< the encoder's steps: a limit cycle of about a step
  friction,      ///< Coulomb friction holds a body still: a limit cycle of the rest
};

/// What was seen of the oscillation.
struct DiagnosisOptions {
  double frequency = 0.0;                ///< observed, rad/s; above 0, at most pi/T
  std::optional<double> amplitude = {};  ///< observed, of the sensed position, m or rad; > 0
  /// K of the wall, 0 for a damper alone; absent: the device's own wall.stiffness, or unknown
  std::optional<double> stiffness = {};
  std::optional<double> damping = {};  ///< B; absent: the device's own wall.damping
  Progress progress = {};              ///< told how far the work is; ends it by throwing
};

/// Checks every member's range for the device.
[[nodiscard]] std::optional<OptionProblem> find_problem(const DiagnosisOptions& options, const Device& device);

/// The same where a recording shows the oscillation; member "recording" for one that the device's loop cannot see.
[[nodiscard]] std::optional<OptionProblem> find_problem(const DiagnosisOptions& options, const Device& device,
                                                        const Recording& recording);

/// What would have to be otherwise for a candidate to fit; each a factor, 1 where nothing has to.
struct OtherwiseNeeded {
  double limit = 1.0;      ///< of the limit that the numbers of the device give: K / limit
  double frequency = 1.0;  ///< of the frequency that they give
  double amplitude = 1.0;  ///< of the amplitude that they give
};

/// One thing that the oscillation may be.
struct OscillationCandidate {
  OscillationCause cause = OscillationCause::device;  ///< what it would be
  bool fits = false;                                  ///< whether what was seen agrees with it
  double frequency = 0.0;                             ///< rad/s, where it would oscillate, nearest to the one observed
  std::optional<double> stiffness;                    ///< K from which on it may; absent of a damper alone
  std::optional<double> amplitude;                    ///< of the sensed position; of quantisation and friction
  std::optional<Oscillator> limited_by;               ///< of a linear crossover
  Finding why;                                        ///< why it fits or not
  std::optional<OtherwiseNeeded> otherwise = {};      ///< absent where it fits, and where no factor makes it fit
  std::optional<double> damping = {};                 ///< of a damper alone: B from which on it may
};

/// One change of the device or the wall alone, recomputed.
struct DiagnosisChange {
  /// What is done to it.
  enum class Kind {
    more_body_damping,    ///< 20 % more damping of every body
    half_delay,           ///< half the delay
    twice_sampling_rate,  ///< twice the sampling rate
    half_actuator_lag,    ///< half the actuator's lag
    no_velocity_filter,   ///< the damper's velocity as it comes
    stiffer_link,         ///< a link 20 % stiffer
    finer_encoder,        ///< an encoder four times as fine
    half_damper,          ///< half the damper, where steps of the encoder make the device swing
    weaker_damper,        ///< a damper 6 dB below the limit
    half_stiffness,       ///< half the stiffness, where steps of the encoder make the device swing
    softer_wall,          ///< a stiffness 6 dB below the limit
    other_damper,         ///< the best of some virtual dampers
    notch,                ///< a notch at the frequency observed
    damper_on_drive,      ///< with_damper_on_drive(), with the best of some virtual dampers
    half_damper_delay,    ///< half the delay of a damper in a loop of its own
    twice_damper_rate,    ///< twice the rate of a damper in a loop of its own
    twice_tracking,       ///< twice the bandwidth of the drive's tracking of the position
  };
  Kind kind = Kind::more_body_damping;   ///< which change
  std::optional<std::size_t> link = {};  ///< of stiffer_link: from 0
  std::string key = {};     ///< of the device file; "body.*.damping" for all bodies, "wall.filter" for a filter more
  double value_now = 0.0;   ///< SI units
  double value_then = 0.0;  ///< of wall.filter: the centre of a notch, Hz
  std::optional<double> damping_then = {};  ///< of damper_on_drive: the B that is run
  std::optional<double> delay_then = {};    ///< of damper_on_drive: the delay of its force, s
  /// The stiffness (of a damper alone its B) up to which the cause is absent: K_CR, that with friction holding, or the
  /// absolute stability limit; absent of quantisation, whose amplitude the change alters.
  std::optional<double> limit_now = {};
  std::optional<double> limit_then = {};      ///< infinite where unbounded
  std::optional<double> amplitude_now = {};   ///< m or rad, of a cycle; absent where its size is not known
  std::optional<double> amplitude_then = {};  ///< the same, after the change
  /// limit_then times the nearest cause's `otherwise.limit` is above K (B); absent where K is not known.
  std::optional<bool> ends_it = {};
  /// absolute_stability_limit() after the change, of a damper alone absolute_stability_damping(); infinite where nobody can destabilise a
  /// wall, absent where the device cannot be held or the limit is not found.
  std::optional<double> absolute_stability_limit_then = {};
  std::optional<bool> safe = {};  ///< known to be no lower then than now; absent where that of now is not known
};
/// What is done to it: "damping of every body + 20 %".
[[nodiscard]] std::string words_of(const DiagnosisChange& change);

/// What an oscillation is, and what moves it.
struct Diagnosis {
  std::optional<double> frequency;               ///< observed, rad/s; absent where a recording shows no oscillation
  std::optional<double> amplitude;               ///< observed, where it is known
  std::optional<double> stiffness;               ///< K taken; absent: unknown
  double damping = 0.0;                          ///< B taken
  WallNumber limit_of = WallNumber::stiffness;   ///< which number all limits are of; damping where K = 0
  std::vector<OscillationCandidate> candidates;  ///< the likeliest first: those that fit, then the nearest
  std::optional<OscillationCause> cause;         ///< of the first, where it fits; absent: none does
  /// The first candidate's, where it fits or would fit with each number within a factor of 2, as well as a device's
  /// numbers are commonly known.
  std::optional<OscillationCause> nearest;
  std::optional<double> absolute_stability_limit_now;  ///< of the device as it is; absent as the limit then
  /// What moves the nearest cause, by falling limit, then what lowers absolute_stability_limit_now; none where there is no such cause.
  std::vector<DiagnosisChange> changes;
  HoldingLimits limits;         ///< of the device as its file has it; NaN where refused
  Trust trust;                  ///< where refused, nothing else is held
  std::vector<Remark> remarks;  ///< what is worth knowing beside it
};

/// Which mechanism an oscillation at a given frequency is, and what moves it.
///
///     device, with_user   a closed-loop pole |z| > 1 of the wall (K, B) at e^{jwT}, or a phase crossover below K; K
///                             unknown: a phase crossover
///     passive_user            K above the least K(w) with |1 + C c_T| = |C| r_T (absolute_stability_limit())
///     quantisation            1 + N t C P = 0 at a phase crossover t > 1 of the stable loop; the encoder rests between two
///                             steps q, a relay of +-q/2: amplitude 2 q/(pi t)
///     (a damper alone, K = 0)  the same with B for K: critical_damping(), absolute_stability_damping()
///     friction                the loop is stable while bodies slide, and unstable with the first harmonic of their
///                             Coulomb friction, a damping 4 F_c/(pi V): V where it is just critical
///
/// The last two are first harmonics, approximate. A swing of a loop that is stable without the encoder's steps is theirs
/// whatever its frequency (steps that are far from a sine swing far from the crossover, and a resonance swings by many)
/// up to what an error within half a step keeps up there, |C P/(1 + C P)| 2 q/pi, or three steps. Where the amplitude
/// is not given the frequency alone tells; two causes that fit nearly as well make the answer doubtful.
/// With a damper in a loop of its own the poles are those over the longer period, and the observed frequency may lie up to
/// Nyquist of the shorter one; no user is looked for where the limit over all of them is not known, and no cycle of the
/// encoder's steps: remarks say so.
/// Throws Error (invalid_argument) where find_problem() finds one, (did_not_converge) as its parts do.
[[nodiscard]] Diagnosis diagnose(const Device& device, const DiagnosisOptions& options);

/// The same of the oscillation that a recording shows: dominant_oscillation() of its first channel, the sensed position
/// in m or rad, gives the frequency, and the amplitude where the options have none. Refused where nothing oscillates:
/// its share of what moves is below 0.1. Doubtful below 0.5, and where its change is below 0.7: it dies out.
[[nodiscard]] Diagnosis diagnose(const Device& device, const Recording& recording, const DiagnosisOptions& options);

}  // namespace zwidth
