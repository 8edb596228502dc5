#pragma once

#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"

namespace zwidth {

/// Which stiffness a design is to raise.
enum class StiffnessGoal {
  critical_stiffness,  ///< of the device as it is: free, or held by its [operator]
  any_user_limit,      ///< with every passive user
};

struct NotchOptions {
  StiffnessGoal goal = StiffnessGoal::critical_stiffness;
  /// The vibration modes may lie anywhere from (1 - drift) to (1 + drift) times their frequency (a cable's tension
  /// changes); from 0 to 0.9. See drifted().
  double drift = 0.0;
  double gain_margin = 1.0;   ///< least factor from the wall's stiffness to the goal's; >= 1
  double phase_margin = 0.0;  ///< least phase margin of the wall on the device as it is, rad; from 0 to pi/2
  Progress progress = {};
};

/// What one notch does with the modes shifted by one factor.
struct NotchAtDrift {
  double drift = 0.0;    ///< frequencies are (1 + drift) times the nominal
  double without = 0.0;  ///< stiffest wall that keeps the margins, without the notch; infinite where unbounded
  double with = 0.0;     ///< with it
};

struct NotchDesign {
  std::optional<WallFilter> notch;  ///< absent: none makes the worst wall stiffer
  double without = 0.0;             ///< least over the drift, without a notch
  double with = 0.0;                ///< least over the drift, with it; equal to `without` where there is none
  std::vector<NotchAtDrift> over_drift;
  /// What it costs: below its centre it delays the force by this much, 2 z (1 - depth)/w, s; the wall feels less damped
  /// by K times it.
  double low_frequency_delay = 0.0;
};

/// The device with its vibration modes shifted by the factor 1 + drift: stiffness of every link times (1 + drift)²,
/// damping of every link times 1 + drift, so that the damping ratios stay. Exact where nothing else has springs or
/// dampers.
/// Throws Error (invalid_argument) for a drift outside (-1, 10], or a device without links.
[[nodiscard]] Device drifted(const Device& device, double drift);

/// The stiffest wall that keeps the margins: goal/gain_margin, or less where the phase margin asks for it (the stiffest
/// found going down from there; softer walls may have less phase margin).
/// The device's damper and filters are closed. Infinite where unbounded, 0 where there is none.
[[nodiscard]] double stiffest_wall(const Device& device, const NotchOptions& options);

/// The notch that makes the least stiffest_wall() over the drift greatest.
///
/// Maximises over centre, width and depth the minimum over the drift: a grid around every mode (or the alias at which
/// the wall sees it) and around the softest crossovers (or the worst user's frequency), then pattern search from the
/// best of each; the worst drift found joins the search until it holds. A local optimum, found by search: there may be
/// better notches. What it promises is recomputed at 41 drifts, refined between them around every local minimum, and
/// shaved by 1e-6; the least with the notch is never below the least without. Runs after the filters that the wall has.
/// Throws Error (invalid_argument) for options outside their range or a device without vibration modes.
[[nodiscard]] NotchDesign design_notch(const Device& device, const NotchOptions& options);

}  // namespace zwidth
