#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// Which stiffness a design is to raise.
enum class StiffnessGoal {
  critical_stiffness,        ///< of the device as it is: free, or held by its [operator]
  absolute_stability_limit,  ///< with every passive user
};

/// What the notch is to be designed for.
struct NotchOptions {
  StiffnessGoal goal = StiffnessGoal::critical_stiffness;  ///< which limit is to become highest
  /// The vibration modes may lie anywhere from (1 - uncertainty) to (1 + uncertainty) times their frequency (a cable's tension
  /// changes); from 0 to 0.9. See with_modal_shift().
  double modal_frequency_uncertainty = 0.0;
  /// Least factor from the wall's stiffness to the goal's with the damper as it is, and on the whole force; from 1 to
  /// 1e5.
  double gain_margin = 2.0;                      // 6 dB
  double phase_margin = std::numbers::pi / 6.0;  ///< least phase margin of the wall, rad; from 0 to pi/2
  bool far_from_modes = false;  ///< the centre may lie anywhere; else within half to twice a mode as the wall sees it
  bool lower_absolute_stability_limit = false;  ///< it may become lower than without the notch
  Progress progress = {};                       ///< told how far the work is; ends it by throwing
};

/// Checks every member's range, and the device: a vibration mode below Nyquist or an alias of one, and for the absolute stability
/// goal a body to hold.
[[nodiscard]] std::optional<OptionProblem> find_problem(const NotchOptions& options, const Device& device);

/// What one notch does with the modes shifted by one factor.
struct NotchAtModalShift {
  double modal_shift = 0.0;  ///< frequencies are (1 + modal_shift) times the nominal
  double without = 0.0;      ///< stiffest wall that keeps the margins, without the notch; infinite where unbounded
  double with = 0.0;         ///< with it
};

/// The device as it is with the designed wall in [wall], and its answer.
struct NotchState {
  Device device;      ///< with that wall
  Analysis analysis;  ///< of it
};

/// The notch found, and what it gives.
struct NotchDesign {
  std::optional<WallFilter> notch;  ///< absent: none makes the worst wall stiffer
  double without = 0.0;             ///< least over the modal shift, without a notch
  double with = 0.0;                ///< least over the modal shift, with it; equal to `without` where there is none
  std::vector<NotchAtModalShift> over_modal_shift;  ///< by rising modal shift
  /// What it costs: below its centre it delays the force by this much, 2 z (1 - depth)/w, s; the wall feels less damped
  /// by K times it.
  double low_frequency_delay = 0.0;
  std::optional<NotchState> state_without;  ///< absent where refused
  std::optional<NotchState> state_with;     ///< absent where there is no notch
  Trust trust;                              ///< of the whole answer
  std::vector<Remark> remarks;              ///< what is worth knowing beside it
};

/// The device with its vibration modes shifted by the factor 1 + modal_shift: stiffness of every link times (1 + modal_shift)²,
/// damping of every link times 1 + modal_shift, so that the damping ratios stay. Exact where nothing else has springs or
/// dampers.
/// Throws Error (invalid_argument) for a modal shift outside (-1, 10], or a device without links.
[[nodiscard]] Device with_modal_shift(const Device& device, double modal_shift);

/// The stiffest wall that keeps the margins: goal/gain_margin, or less where the margins of the whole force ask for it
/// (found going down from there; walls between gaps narrower than a step of a fifth are passed over).
/// The device's damper and filters are closed. Infinite where unbounded, 0 where there is none.
[[nodiscard]] double stiffest_wall(const Device& device, const NotchOptions& options);

/// The notch that makes the least stiffest_wall() over the modal shift greatest.
///
/// Maximises over centre, width and depth the minimum over the modal shift: a grid around every mode (or the alias at which
/// the wall sees it), then pattern search from the best of each, all on a grid of frequencies; the worst modal shift found
/// joins the search until it holds. A local optimum, found by search: there may be better notches. What is proposed is
/// recomputed exactly at 41 modal shifts, refined between them around every local minimum, and shaved by 1e-6: there the wall
/// is stable and keeps the margins asked, and the absolute stability limit is not below that without the notch (unless
/// lower_absolute_stability_limit). Runs after the filters that the wall has.
/// Throws Error (invalid_argument) where find_problem() finds one, (did_not_converge) as its parts do.
[[nodiscard]] NotchDesign design_notch(const Device& device, const NotchOptions& options);

}  // namespace zwidth
