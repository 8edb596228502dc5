#pragma once

#include <optional>
#include <vector>

#include "stability/damper_response.hpp"
#include "stability/disc_pieces.hpp"
#include "stability/user_discs.hpp"
#include "zwidth/stability/any_user.hpp"

namespace zwidth::internal {

/// any_user_limit() of one device for many dampers: the discs do not depend on the damper and are summed once.
///
/// A scan finds the minimum; then WallCondition shows on all of (0, pi/T], interval by interval, that nothing lies
/// below it. Where that finds a frequency the scan has missed, the minimum there is taken.
class AnyUserSearch {
 public:
  /// Throws as any_user_limit().
  explicit AnyUserSearch(const Device& device, const Progress& progress = {});
  AnyUserSearch(const AnyUserSearch&) = delete;
  AnyUserSearch& operator=(const AnyUserSearch&) = delete;
  ~AnyUserSearch() = default;

  [[nodiscard]] AnyUserLimit limit(VirtualDamper damper, const Progress& progress = {});

  /// any_user_damping(): AnyUserLimit::stiffness holds B.
  [[nodiscard]] AnyUserLimit damping_limit(double velocity_filter_hz, const Progress& progress = {});

 private:
  /// The stiffness that the condition allows at one frequency, rad/s.
  struct Sample {
    UserDiscs::Place place;
    double stiffness = 0.0;
  };
  /// Which gain is free; VirtualDamper::damping is 1 N s/m where it is the damper's.
  enum class FreeGain { stiffness, damping };
  [[nodiscard]] AnyUserLimit limit_of(VirtualDamper damper, const CriticalStiffness& free, const Progress& progress);
  [[nodiscard]] WallResponse wall_at(VirtualDamper damper, double frequency) const;
  [[nodiscard]] double limit_at(VirtualDamper damper, const UserDiscs::Place& place) const;
  [[nodiscard]] double quick_limit_at(VirtualDamper damper, const UserDiscs::Place& place) const;
  [[nodiscard]] std::vector<Sample> scan(VirtualDamper damper, const CriticalStiffness& free) const;
  void take_least_of(VirtualDamper damper, const std::vector<Sample>& samples, Sample& least) const;
  [[nodiscard]] Sample least_within(VirtualDamper damper, const DiscPieces::Piece& piece,
                                    const UserDiscs::Place& at) const;
  void look_at_zeros(VirtualDamper damper, Sample& least) const;
  [[nodiscard]] std::optional<double> beaten_by_tuned_user(VirtualDamper damper, double stiffness) const;
  [[nodiscard]] double prove(VirtualDamper damper, const Progress& progress, Sample& least);

  Device free_;
  UserDiscs discs_;
  FreeGain free_gain_ = FreeGain::stiffness;
  double period_ = 0.0;
  DiscPieces pieces_;
  std::vector<double> frequencies_;        // where the condition may be tightest with any damper, rising
  std::vector<UserDiscs::Disc> discs_at_;  // at those
};

}  // namespace zwidth::internal
