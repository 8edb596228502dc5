#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/stiffness_interval.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// How a safe wall is chosen.
struct SafeWallOptions {
  double safety_factor = 0.5;  ///< of every limit
  /// Which B the wall is to have.
  enum class Damping {
    own,      ///< the device's own wall.damping, closed while the stiffness is chosen
    ceiling,  ///< chosen too: ceilings of both that may be used alone or together
  };
  Damping damping = Damping::own;    ///< of the device's own wall unless asked
  std::size_t draws = 1000;          ///< of the device's uncertainty, where it has one, for K_CR
  std::size_t any_user_draws = 200;  ///< the same for the limit with any passive user
};

/// Checks: safety_factor above 0 and below 1; draws and any_user_draws at least 1.
[[nodiscard]] std::optional<OptionProblem> find_problem(const SafeWallOptions& options);

/// A wall with a margin to the limit, to be rendered.
struct SafeWall {
  /// What the ceiling is a share of.
  enum class Basis {
    any_user,  ///< whoever holds the device
    device,    ///< the device that nobody holds, and with its own user if it has one: the lesser limit of both
  };
  /// Whether a wall was chosen.
  enum class Status {
    chosen,
    none_stable,  ///< no wall is stable from K = 0 on: there is nothing to take a share of
    unbounded,    ///< every wall is stable: there is no limit to take a share of
    refused,      ///< see trust
  };
  Status status = Status::chosen;  ///< chosen, or why not
  Basis basis = Basis::device;     ///< what the ceiling is a share of
  double limit = 0.0;              ///< K where stability ends: the absolute stability limit, or the lesser K_CR
  double stiffness = 0.0;          ///< K chosen
  double damping = 0.0;            ///< B of it: the device's own, or the ceiling
  /// With Damping::ceiling the least B at which some wall of 0 < K <= stiffness is not stable.
  std::optional<double> damping_limit;
  std::optional<StiffnessInterval> interval;  ///< of the lesser K_CR, where the device has an uncertainty
  std::optional<StiffnessInterval>
      absolute_stability_interval;  ///< of the absolute stability limit, where that is the basis too
  /// The lower end of that interval over K_CR, or of the absolute stability limit's over that limit where it is less, at most 1:
  /// every limit is taken at this share. 1 without an uncertainty.
  double uncertainty_share = 1.0;
  Trust trust;  ///< the device's, and what the check of the wall found; where refused, no number is held
  std::vector<Remark> remarks;  ///< on what the limits rest
};

/// A share of what the device renders stably.
///
///     stiffness = safety_factor * uncertainty_share * limit
///
/// `limit` is the absolute stability limit (absolute_stability_limit()) where there is one, else the lesser of the K_CR with nobody holding and
/// with the device's own user: a person lets go. With Damping::own the device's damper
/// stays closed; with Damping::ceiling `limit` is that at B = 0, and
///
///     damping = safety_factor * uncertainty_share * damping_limit
///
/// A program may then use the stiffness alone, the damping alone, or both, and any less of them: so the whole rectangle
/// must be stable. damping_limit is the lowest boundary of the region over 0 < K <= stiffness: of the absolute stability region
/// (absolute_stability_region(), sampled over B) where absolute_stability_limit() at B = 0 is above 0, else of stable_region() with nobody and
/// with the device's own user. The velocity filter and the filters of the wall stay in. Where the device has an uncertainty, `damping` is lowered until all but 2.5 %
/// of the devices drawn from it keep the rectangle whoever holds them.
///
/// The wall chosen, or walls over the whole rectangle, with nobody and with the own user, are asked of a second route, closed-loop poles by matrix
/// exponential: where one is not stable the answer is `refused`, and so it is for a refused device.
/// Where the damper runs in a loop of its own, it must be as fast as the spring or faster, and their delays differ by whole
/// periods of it, so that the limit over all passive users is known; Error (invalid_argument) else.
/// Throws Error (invalid_argument) where find_problem() finds one.
[[nodiscard]] SafeWall safe_wall(const Device& device, const SafeWallOptions& options = {});

}  // namespace zwidth
