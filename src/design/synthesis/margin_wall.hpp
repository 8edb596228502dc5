#pragma once

// The stiffest wall that keeps margins, for whatever proposes walls: exactly, and on a grid of frequencies for
// searches.

#include <complex>
#include <limits>
#include <optional>
#include <vector>

#include "design/region/seen_crossings.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

/// What a proposed wall keeps. `gain` is a margin twice over: the stiffness alone may grow by it with the damper as it
/// is, and so may the whole force.
struct RequiredMargins {
  double gain = 1.0;      // factor >= 1
  double phase = 0.0;     // rad in [0, pi/2], lag and lead
  bool any_user = false;  // the gain margin of the stiffness holds with every passive user
};

/// What is wrong with the margins asked for: a gain from 1 to 1e5 (100 dB), a phase from 0 to pi/2.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RequiredMargins& margins);

/// The stiffest K with gain * K inside the stable interval that begins at 0 (of every user where asked) and the margins
/// of the loop kept at K; its softer neighbours keep them too, and all of them down to 0 where no gap is met on the way
/// (gaps narrower than the steps of the walk are passed over). Infinite where nothing bounds it, 0 where there is none.
[[nodiscard]] double stiffest_wall(const Device& device, const RequiredMargins& margins);

/// What a search knows of the answer before.
struct StiffnessRange {
  double at_least = 0.0;  ///< 0 is as good as less than this, or as a wall that keeps the margins where this does not
  double at_most = std::numeric_limits<double>::infinity();  ///< the walk begins no higher
};

/// The same within a range, behind the plant's own filters; whoever holds the device is left out. `seen`: what a grid
/// shows of this plant with this damper; each crossing is isolated only where that does not decide.
[[nodiscard]] double stiffest_wall(const FilteredPlant& plant, VirtualDamper damper, const RequiredMargins& margins,
                                   const StiffnessRange& range, const Progress& progress = {},
                                   const SeenCrossings* seen = nullptr);

/// Whether that wall keeps the margins; stable, strictly.
[[nodiscard]] bool keeps_margins(const Device& device, double stiffness, const RequiredMargins& margins);

/// A loop on a grid of frequencies: evenly over the logarithm, closer at Nyquist and around every resonance. What a
/// search compares is seen on it; what is proposed is recomputed exactly.
class LoopGrid {
 public:
  using Response = std::vector<std::complex<double>>;  // one value per frequency

  LoopGrid(const Device& device, bool with_users, const Progress& progress = {});

  [[nodiscard]] std::size_t size() const { return angles_.size(); }

  /// The same with another virtual damper.
  [[nodiscard]] LoopGrid with_damper(VirtualDamper damper) const;

  /// F at the grid's frequencies.
  [[nodiscard]] Response filter(const WallFilter& filter) const;

  /// B v of that damper at the grid's frequencies.
  [[nodiscard]] Response damper(VirtualDamper damper) const;

  /// The crossings that the grid shows behind this factor more; `plant`: the device's with the factor in it.
  [[nodiscard]] SeenCrossings seen(const FilteredPlant& plant, VirtualDamper damper, const Response& factor) const;

  /// Of the wall's force behind this factor more: stiffest_wall(), as far as the grid tells; with the device's own
  /// damper, or with this one.
  /// Some value not above `enough` as soon as it is seen to be that.
  [[nodiscard]] double stiffest(const Response& factor, const RequiredMargins& margins, double enough) const;
  [[nodiscard]] double stiffest(const Response& factor, const Response& damper, const RequiredMargins& margins,
                                double enough) const;
  /// The absolute stability limit behind this factor more; infinite where the grid has no users.
  [[nodiscard]] double any_user(const Response& factor) const;
  /// With `scale` times this damper.
  [[nodiscard]] double any_user(const Response& factor, const Response& damper, double scale) const;
  /// The stiffest wall of the range whose gain crossovers, between the grid's points too, keep the phase margin.
  [[nodiscard]] double stiffest_in_phase(const Response& factor, const Response& damper, const StiffnessRange& range,
                                         double phase_margin) const;
  [[nodiscard]] double stiffest_in_phase(const Response& factor, const StiffnessRange& range,
                                         double phase_margin) const;
  /// The least B at which the damper alone is critical, of the device or of one that somebody holds; `unit_damper`: v.
  [[nodiscard]] double largest_damping(const Response& factor, const Response& unit_damper) const;

 private:
  [[nodiscard]] bool keeps_phase(const Response& factor, const Response& damper, double stiffness,
                                 double phase_margin) const;

  double period_ = 0.0;
  std::vector<double> angles_;
  Response deltas_;                            // z - 1
  Response plant_;                             // seen through the wall's own filters
  Response damper_;                            // B v
  std::vector<bool> clear_;                    // of rounding, the plant
  std::vector<TerminationDiscs::Disc> discs_;  // behind the wall's own filters
};

}  // namespace zwidth::internal
