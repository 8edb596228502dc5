#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "model/device_matrices.hpp"
#include "model/drive_path.hpp"
#include "stability/users/alias_sum_quadrature.hpp"
#include "stability/users/dissipation_zeros.hpp"
#include "stability/users/shared_poles.hpp"
#include "stability/users/solved_motions.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

/// Above this angle, rad per sample, |c_T| - r_T keeps its digits by subtraction: it loses as many as 1/(w T)².
inline constexpr double clear_angle = 0.1;

/// The passive termination circles of the sampled plant: at each frequency the disc |p - centre| <= radius (see absolute_stability.hpp).
class TerminationDiscs {
 public:
  /// The device must have bodies or coordinates; its user is left out.
  explicit TerminationDiscs(const Device& device, const Progress& progress = {});

  struct Disc {
    std::complex<double> centre;  // c_T
    double radius = 0.0;          // r_T; infinite where nothing damps the motion that the user can drive
    double power = 0.0;           // |c_T|² - r_T², to its own digits where both grow without bound (w -> 0)
    double one = 1.0;             // what the others are multiples of: 0 where the disc is a half plane
  };
  /// 0 < frequency <= pi/T, rad/s. Not scaled; beside a half plane, where it would be one.
  [[nodiscard]] Disc at(double frequency) const;

  /// A frequency base + offset, rad/s, of which the distance from `base` keeps its digits.
  struct Place {
    double base = 0.0;
    double offset = 0.0;
    [[nodiscard]] double frequency() const { return base + offset; }
  };
  /// The disc of one alias or a few, over `one`: the product of the measures of sharp zeros of Re Y.
  [[nodiscard]] Disc scaled_at(const Place& place) const;

  /// An alias number * 2 pi/T + side * w, in which a zero of Re Y lies on the axis or nearly so, at w = image.
  struct SharpImage {
    double number = 0.0;
    double side = 1.0;   // or -1
    double image = 0.0;  // rad/s, in 0..pi/T or beside it
    std::size_t zero = 0;
  };
  /// By number and side; such aliases are in no sum of others.
  [[nodiscard]] const std::vector<SharpImage>& sharp_images() const { return sharp_images_; }
  [[nodiscard]] const DissipationZeros& zeros() const { return zeros_; }
  /// Positive, and with the measures of the zeros even in the frequency.
  [[nodiscard]] double mirrored_measures(double frequency) const;

  /// What all aliases but the frequency itself and the sharp ones add, over the factor F (1 - e^{-jwT}) e^{-jwt_d}/T that all terms share.
  struct OtherAliases {
    std::complex<double> centre;  // sum of (G_sa - D)/(jw_k)
    double radius = 0.0;          // sum of |D/w_k|
  };
  [[nodiscard]] OtherAliases other_aliases(double frequency) const;
  /// Parts of it: the aliases next to which a mode may lie, and all beyond, the poles of which are far from (0, pi/T].
  [[nodiscard]] OtherAliases near_aliases(double frequency) const;
  [[nodiscard]] OtherAliases far_aliases(double frequency) const;

  /// The same disc as scaled_at() from its own term, the sharp aliases and a sum of the others, and a positive factor
  /// that makes own terms polynomials in the frequency, of twice the order of the device at most: 2 w² q^H Dmp q times |det(Z)|², over
  /// `unit` and over the squared distances from sharp zeros; divided by it, own terms have poles at its zeros only, near the real axis where little is dissipated.
  struct SplitDisc {
    Disc disc;
    double factor = 0.0;
    double shared = 0.0;  // |F (1 - e^{-jwT})/T|: what an error of `others` counts
  };
  [[nodiscard]] SplitDisc with_others(const Place& place, const OtherAliases& others, double unit) const;

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
  [[nodiscard]] const ModalForm& held_form() const noexcept { return held_motion_; }
  /// Relative error that the sums over aliases may leave, from a second, finer rule.
  [[nodiscard]] double truncation() const noexcept { return truncation_; }
  /// The discs are infinite at every frequency: nothing dissipates, or so little far up that their sum diverges.
  [[nodiscard]] bool is_undamped() const noexcept { return undamped_; }
  /// How the aliases are summed, and the derivative of the turning weights by the angle 2 pi t_d / T.
  [[nodiscard]] const AliasSumQuadrature& rule() const noexcept { return rule_; }
  [[nodiscard]] AliasSumQuadrature rule_derivative() const;

 private:
  struct Density {
    std::complex<double> value;  // g(w)
    double conductance = 0.0;    // Re Y = w² q^H Dmp q
  };

  /// g(w) = D(jw) / (jw) = q_s q_a E / (2 w² q^H Dmp q).
  [[nodiscard]] Density density(double frequency) const;
  [[nodiscard]] std::complex<double> disc_density(double frequency) const { return density(frequency).value; }
  [[nodiscard]] OtherAliases sum_of_aliases(double frequency, std::size_t first, std::size_t end) const;
  [[nodiscard]] Disc summed(const AliasSumQuadrature& rule, double frequency) const;
  /// Times the measures of sharp zeros: g, and Re Y over what of it vanishes there.
  struct ScaledDensity {
    std::complex<double> value;
    double conductance = 0.0;
    double measure = 1.0;
    double of_product = 1.0;  // the measure over what is taken off the conductance
  };
  [[nodiscard]] ScaledDensity scaled_density(const Place& place, double number, double side) const;
  [[nodiscard]] Disc near_zero(double frequency, const ScaledDensity& own, const OtherAliases& others) const;
  [[nodiscard]] Disc joined(const Disc& own, double measure, std::complex<double> shared,
                            const OtherAliases& others) const;
  [[nodiscard]] Disc clear_of_zero(double frequency, const ScaledDensity& own, const OtherAliases& others) const;
  void add_sharp_aliases(const Place& place, Disc& disc) const;
  void find_sharp_images();
  void set_rules(double highest_mode, double highest_corner);
  [[nodiscard]] bool is_sharp(double number, double side) const;
  [[nodiscard]] std::complex<double> shared_factor(double frequency) const;
  [[nodiscard]] std::complex<double> kept_motion(double frequency) const;

  ModalForm held_motion_;  // for a force at the held body, as the next two
  ModalForm sensed_motion_;
  ModalForm actuated_motion_;
  ModalForm through_;  // actuated -> sensed, the drive left out
  DeviceMatrices<long double> matrices_;
  std::vector<Weights> ports_;    // actuated, sensed and held
  std::vector<ModalTerm> poles_;  // the terms whose denominators are those of the device
  SharedPoles motions_;           // for a force at the held body: sensed, actuated, and the length of each damper
  SolvedMotions solved_;          // the same, where terms of these cancel
  std::vector<double> dampings_;  // of those
  std::size_t sensed_ = 0;
  std::size_t actuated_ = 0;
  std::size_t held_ = 0;
  DrivePath drive_;
  double period_ = 0.0;
  double delay_ = 0.0;
  FilteredPlant plant_;  // of the free device
  bool undamped_ = false;
  DissipationZeros zeros_;
  std::vector<SharpImage> sharp_images_;
  AliasSumQuadrature rule_;
  std::size_t exact_aliases_ = 0;  // of the rule
  std::size_t near_aliases_ = 0;   // of these, w itself among them
  double steady_alias_ = 0.0;
  double truncation_ = 0.0;
};

}  // namespace zwidth::internal
