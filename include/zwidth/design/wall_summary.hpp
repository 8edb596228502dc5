#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// The stiffest wall over all virtual dampers, and who may hold the device at it.
struct StiffestDampedWall {
  double stiffness = 0.0;            ///< every K below is stable at this B; 0: none is; infinite: all are
  double damping = 0.0;              ///< B
  double velocity_filter_hz = 0.0;   ///< the file's; 0: none
  Holder holder = Holder::any_user;  ///< nobody for a transfer function, which none can hold
  Trust trust = {};                  ///< of that limit
};

/// Beyond, the walls of the summary would take seconds.
inline constexpr std::size_t most_bodies_for_wall_summary = 6;

/// The walls that stand beside the limits of an analysis: how stiff with a damper, and which to run.
struct WallSummary {
  std::optional<StiffestDampedWall> with_damper = {};  ///< the stiffest over all dampers
  std::optional<Finding> why_no_damper = {};           ///< why with_damper is absent
  std::optional<RecommendedWall> with_margins = {};    ///< recommend_wall() without alternatives
  std::optional<Finding> why_no_margins = {};          ///< why with_margins is absent
};

/// What the summary computes, and who is told how far it is.
struct WallSummaryOptions {
  std::size_t most_bodies = most_bodies_for_wall_summary;  ///< beyond, both walls are left out
  Progress progress = {};                                  ///< ends the work by throwing
};

/// The two walls for the first lines of an answer.
///
///     max over 0 <= B < B_CR of absolute_stability_limit(K; B),   B_CR = limits.any_user.critical_damping
///
/// by a search over B (a local maximum beside 24 samples; absolute_stability_region() follows the whole of it), with the velocity
/// filter and the filters of the file; and recommend_wall() with its usual margins. `analysis` is that of the device. Where the
/// damper runs in a loop of its own both are left out unless it is as fast as the spring or faster, with delays that differ by
/// whole periods of it.
/// Throws as these do.
[[nodiscard]] WallSummary wall_summary(const Device& device, const Analysis& analysis,
                                       const WallSummaryOptions& options = {});

}  // namespace zwidth
