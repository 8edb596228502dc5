#pragma once

#include <optional>
#include <vector>

#include "stability/loop/damper_response.hpp"
#include "stability/users/any_grasp.hpp"
#include "stability/users/disc_pieces.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {

/// absolute_stability_limit() of one device for many dampers: the discs do not depend on the damper and are summed once.
///
/// A scan finds the minimum; then WallCondition shows on all of (0, pi/T], interval by interval, that nothing lies
/// below it. Where that finds a frequency the scan has missed, the minimum there is taken. Of a mechanism: AnyGrasp.
class AbsoluteStabilitySearch {
 public:
  /// Throws as absolute_stability_limit().
  explicit AbsoluteStabilitySearch(const Device& device, const Progress& progress = {});
  AbsoluteStabilitySearch(const AbsoluteStabilitySearch&) = delete;
  AbsoluteStabilitySearch& operator=(const AbsoluteStabilitySearch&) = delete;
  ~AbsoluteStabilitySearch() = default;

  [[nodiscard]] AbsoluteStabilityLimit limit(VirtualDamper damper, const Progress& progress = {});

  /// absolute_stability_damping(): AbsoluteStabilityLimit::stiffness holds B.
  [[nodiscard]] AbsoluteStabilityLimit damping_limit(double velocity_filter_hz, const Progress& progress = {});

 private:
  /// The stiffness that the condition allows at one frequency, rad/s.
  struct Sample {
    TerminationDiscs::Place place;
    double stiffness = 0.0;
  };
  using FreeGain = AnyGrasp::FreeGain;
  [[nodiscard]] AbsoluteStabilityLimit limit_of(VirtualDamper damper, const CriticalStiffness& free,
                                                const Progress& progress);
  [[nodiscard]] WallResponse wall_at(VirtualDamper damper, double frequency) const;
  [[nodiscard]] double limit_at(VirtualDamper damper, const TerminationDiscs::Place& place) const;
  [[nodiscard]] double quick_limit_at(VirtualDamper damper, const TerminationDiscs::Place& place) const;
  [[nodiscard]] std::vector<Sample> scan(VirtualDamper damper, const CriticalStiffness& free) const;
  void take_least_of(VirtualDamper damper, const std::vector<Sample>& samples, Sample& least) const;
  [[nodiscard]] Sample least_within(VirtualDamper damper, const DiscPieces::Piece& piece,
                                    const TerminationDiscs::Place& at) const;
  void look_at_zeros(VirtualDamper damper, Sample& least) const;
  [[nodiscard]] std::optional<double> beaten_by_tuned_user(VirtualDamper damper, double stiffness) const;
  [[nodiscard]] double prove(VirtualDamper damper, const Progress& progress, Sample& least);

  Device free_;
  TerminationDiscs discs_;
  std::optional<AnyGrasp> grasps_;  // of the tip of a mechanism, in place of the discs of discs_
  FreeGain free_gain_ = FreeGain::stiffness;
  double period_ = 0.0;
  DiscPieces pieces_;
  std::vector<double> frequencies_;               // where the condition may be tightest with any damper, rising
  std::vector<TerminationDiscs::Disc> discs_at_;  // at those
};

}  // namespace zwidth::internal
