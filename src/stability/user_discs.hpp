#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "model/device_matrices.hpp"
#include "stability/alias_rule.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

/// Above this angle, rad per sample, |c_T| - r_T keeps its digits by subtraction.
inline constexpr double clear_angle = 3e-3;

/// What passive users make of the sampled plant: at each frequency the disc |p - centre| <= radius (see any_user.hpp).
class UserDiscs {
 public:
  /// The device must have bodies; its operator is left out.
  explicit UserDiscs(const Device& device);

  struct Disc {
    std::complex<double> centre;  // c_T
    double radius = 0.0;          // r_T; infinite where nothing damps the motion that the user can drive
    double power = 0.0;           // |c_T|² - r_T², to its own digits where both grow without bound (w -> 0)
  };
  /// 0 < frequency <= pi/T, rad/s.
  [[nodiscard]] Disc at(double frequency) const;

  /// The disc of one alias, a term of the sum that at() makes.
  struct Alias {
    double frequency = 0.0;  // |w + 2 pi k/T|
    double radius = 0.0;
    /// The reactance X of the lossless user Z = jX that puts this term on its disc's boundary, in the direction asked.
    double reactance = 0.0;
  };
  /// Alias k, whole, of 0 < frequency <= pi/T; `direction`: angle from the centre of the sampled plant's disc. With
  /// each alias on its boundary in the same direction, the sampled plant is on its own. Not for an undamped device.
  [[nodiscard]] Alias alias(double frequency, int k, double direction) const;

  [[nodiscard]] const FilteredPlant& free_plant() const noexcept { return plant_; }
  [[nodiscard]] const ModalForm& held_form() const noexcept { return positions_[held_]; }
  /// Relative error that the sums over aliases may leave, from a second, finer rule.
  [[nodiscard]] double truncation() const noexcept { return truncation_; }
  [[nodiscard]] bool is_undamped() const noexcept { return undamped_; }
  /// How the aliases are summed, and the derivative of the turning weights by the angle 2 pi t_d / T.
  [[nodiscard]] const AliasRule& rule() const noexcept { return rule_; }
  [[nodiscard]] AliasRule rule_slope() const;

 private:
  struct Damper {
    std::size_t first = 0;
    std::size_t second = 0;  // first: to ground
    double damping = 0.0;
  };

  /// g(w) = D(jw) / (jw) = q_s q_a lag / (2 w² q^H Dmp q).
  [[nodiscard]] std::complex<double> disc_density(double frequency) const;
  [[nodiscard]] Disc summed(const AliasRule& rule, double frequency) const;
  [[nodiscard]] Disc near_zero(double frequency) const;
  [[nodiscard]] std::complex<double> centre_density(double frequency) const;
  [[nodiscard]] double own_power(double frequency) const;

  std::vector<ModalForm> positions_;  // of every body, for a force at the held body
  ModalForm through_;                 // actuated -> sensed, the lag left out
  DeviceMatrices<double> matrices_;
  std::vector<Damper> dampers_;
  std::size_t sensed_ = 0;
  std::size_t actuated_ = 0;
  std::size_t held_ = 0;
  double lag_ = 0.0;
  double period_ = 0.0;
  double delay_ = 0.0;
  FilteredPlant plant_;  // of the free device
  bool undamped_ = false;
  AliasRule rule_;
  std::size_t exact_aliases_ = 0;  // of the rule
  double steady_alias_ = 0.0;
  double truncation_ = 0.0;
};

}  // namespace zwidth::internal
