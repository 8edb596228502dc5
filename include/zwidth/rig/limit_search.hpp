#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "zwidth/identification/measured_stiffness.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/signal/ring_down.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The oscillation that decays least, or grows most: of those near the given frequencies, rad/s, and of the strongest
/// one.
///
/// What swings by less than a hundredth of all that moves at the end is left out: it may be the others' leakage.
/// `floor` as in ring_down(), which throws for a period that is not > 0 and for positions that are not finite.
[[nodiscard]] std::optional<RingDown> least_damped_oscillation(std::span<const double> position, double period,
                                                               std::span<const double> frequencies, double floor);

/// Which stiffnesses a rig tries.
struct LimitSearchOptions {
  double start = 0.0;     ///< first stiffness, N/m or N m/rad; > 0
  double ceiling = 0.0;   ///< the most that may be tried; >= start
  double step = 1.15;     ///< from one stiffness to the next, at most; in (1, 2]
  double bracket = 0.01;  ///< relative distance of the last stable and the first unstable one; in (0, 0.5]
  std::vector<double> frequencies = {};  ///< rad/s, where oscillations are predicted
  double floor = 0.0;                    ///< m or rad: swings below are none (an encoder's step); >= 0
};

/// The first member outside its domain.
[[nodiscard]] std::optional<OptionProblem> find_problem(const LimitSearchOptions& options);

/// The wall was rendered with this stiffness, excited by an impulse, and its ringing read.
struct LimitTrial {
  double stiffness = 0.0;        ///< N/m or N m/rad
  std::optional<RingDown> ring;  ///< the oscillation that decays least; absent where none was read
  bool stopped = false;          ///< it grew so much that the run was ended early
  bool cut = false;              ///< a limit or a ramp kept force back: the wall was softer than its stiffness
  double growth_error = 0.0;     ///< 1/s: the growth rate is off by no more, by its deviation and the encoder's step
  [[nodiscard]] bool grows() const {
    return stopped || (ring && ring->growth_rate > 0.0);
  }  ///< the wall seems unstable
  /// by more than growth_error
  [[nodiscard]] bool surely_grows() const { return stopped || (ring && ring->growth_rate > growth_error); }
  /// by more than growth_error
  [[nodiscard]] bool surely_decays() const { return !stopped && ring && ring->growth_rate < -growth_error; }
};

/// The limit of stable walls as measured on a rig.
struct LimitMeasurement {
  std::optional<double> stiffness;  ///< K_CR where the growth rate passes through zero; absent unless trust allows one
  /// Holds the limit of large motion, N/m or N m/rad: from the last that rang down to the first that grew, widened by
  /// three deviations of the growth rates, by what the encoder's step makes of the swing, and downwards by what the size
  /// of the swing makes of it. Absent, too, where no oscillation was read that decays below the limit and grows above
  /// it, and where the size of the swing matters.
  std::optional<Interval> interval;
  /// The limit of large motion is no higher, N/m or N m/rad: the upper end of the interval, whatever the size of the
  /// swing makes of its lower one; without one the softest wall that surely grew, and what the encoder's step makes of
  /// it. Absent where none surely did.
  std::optional<double> at_most;
  double frequency = 0.0;          ///< rad/s, of the oscillation there; 0 where it was not read
  double lower = 0.0;              ///< stiffest wall that rang down; 0: none did
  double upper = 0.0;              ///< softest wall whose oscillation grew; 0: none did
  std::vector<LimitTrial> trials;  ///< in their order
  Trust trust;                     ///< of the stiffness
};

/// Raises the stiffness of a wall, trial by trial, until an oscillation surely grows; then closes in on where it begins to.
///
/// From `start` by `step`, but no further than a hundredth (or what the growth rate's error asks for) beyond where the last
/// two growth rates extrapolate to zero; after the first that surely grows, inside the bracket, by the line through the
/// growth rates at its ends. K_CR is where that line passes zero. A growth rate may be off by
///
///     3 sigma_s + q/(A sqrt(6 n)) w/2
///
/// sigma_s its standard error, q the encoder's step, A the swing in the middle of what was read and n samples per cycle:
/// rounding turns the position's first harmonic by q/(A sqrt(6 n)), and a wall moves an oscillation by K |dp/dK| <= w/2 at
/// most (Rayleigh's quotient). Of walls whose growth is no larger nobody knows whether they are stable: they count by sign
/// next to the limit alone, and where a stiffer one surely decays, or none does, they make the limit doubtful. Ends with the bracket, at the ceiling, and after 60 trials. The one that decays least counts, of
/// the oscillations near the predicted frequencies and of the strongest one. A last trial with a smaller impulse tells
/// whether the size of the swing matters, as with dry friction, of which the device's file may know nothing: all swings
/// of a linear device grow alike.
class LimitSearch {
 public:
  static constexpr std::size_t most_trials = 60;  ///< after which the search ends

  /// Throws Error (invalid_argument) where find_problem() finds one.
  explicit LimitSearch(LimitSearchOptions options);

  /// The stiffness to try next; absent: done.
  [[nodiscard]] std::optional<double> next() const;
  /// The positions after the impulse, at this stiffness. `stopped`: the run was ended because an oscillation grew. `cut`:
  /// force was kept back meanwhile; a limit between such trials is refused.
  /// Throws Error (invalid_argument) for a period that is not > 0 and positions that are not finite.
  void add(double stiffness, std::span<const double> position, double sampling_period, bool stopped, bool cut = false);

  static constexpr double smaller_impulse = 0.5;  ///< of the others
  /// When next() is done, the stiffness to try once more with that share of the impulse: the stiffest that rang down.
  /// Absent where no limit was read.
  [[nodiscard]] std::optional<double> next_smaller() const;
  /// The positions after the smaller impulse. Throws as add() does.
  void add_smaller(std::span<const double> position, double sampling_period);

  /// What has been found so far on this device.
  [[nodiscard]] LimitMeasurement measurement(const Device& device) const;

 private:
  [[nodiscard]] const LimitTrial* surely_unstable() const;  // the softest
  [[nodiscard]] const LimitTrial* surely_stable() const;    // the stiffest below that
  [[nodiscard]] const LimitTrial* unstable() const;         // the softest above that
  [[nodiscard]] const LimitTrial* stable() const;           // the stiffest below that
  [[nodiscard]] double stiffer() const;                     // the next wall while none surely grows
  void doubt_untold(const Units& units, LimitMeasurement& result) const;

  LimitSearchOptions options_;
  double period_ = 0.0;  // s, of the last trial
  std::vector<LimitTrial> trials_;
  bool has_smaller_ = false;
  std::optional<RingDown> smaller_;  // the ringing after the smaller impulse
};

/// Where to begin and end, and what to watch, from what theory predicts: from half of the lower of the two limits, up to
/// half above the critical one. Absent where theory gives no finite limit.
[[nodiscard]] std::optional<LimitSearchOptions> limit_search_options(const Device& device,
                                                                     const CriticalStiffness& predicted,
                                                                     std::optional<double> any_user);

}  // namespace zwidth
