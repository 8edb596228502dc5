#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "model/drive_path.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"
#include "stability/users/alias_sum_quadrature.hpp"

namespace zwidth::internal {

// What the tip's plant becomes in any passive grasp, at one frequency. In m <= 3 directions of the tip; entries beyond are 0.
//
//     P - jw h_s (Z^-1 + Y)^-1 h_a,   (Z^-1 + Y)^-1 = R^-1/2 (1 + U) R^-1/2,   R = Y + Y^H,  |U| <= 1
//     h_s = G(held -> sensed), h_a = G(pushed -> held), Y = jw G(held -> held)
//
// Sampled, each alias has a U of its own: the plant is `centre` + sum of weight L U R over the aliases, |weight L U R| along a
// normal at most weight sqrt(n' L L^H n) sqrt(n' R^H R n).
class GraspDiscs {
 public:
  GraspDiscs(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions,
             const SampledTip& plant);

  // Of one alias: h_s R^-1 h_a, h_s R^-1 h_s^H and h_a^H R^-1 h_a.
  struct Alias {
    double weight = 1.0;
    Eigen::Matrix3cd shift;
    Eigen::Matrix3cd left;
    Eigen::Matrix3cd right;
    Eigen::Matrix3cd sensed;  // L^-1 h_s^H, R = L L^H: left = sensed^H sensed
    Eigen::Matrix3cd pushed;  // L^-1 h_a: right = pushed^H pushed, shift = sensed^H pushed
  };
  // All aliases but the frequency's own.
  struct Others {
    Eigen::Matrix3cd shift = Eigen::Matrix3cd::Zero();
    std::vector<Alias> blocks;  // shifts as they count in the sum
    // A row each: n' weight^2 left n and n' right n by products_of(n).
    Eigen::Matrix<double, Eigen::Dynamic, 6> left_forms;
    Eigen::Matrix<double, Eigen::Dynamic, 6> right_forms;
  };
  // As w -> 0 centre and radius grow as 1/w, and what is left of their squares is what limits a wall: more digits than a double's.
  using Real = long double;
  // All over `shared`.
  struct Sample {
    double angle = 0.0;
    std::complex<double> shared;                     // (1 - e^{-jwT}) e^{-jwt_d}/T
    Eigen::Matrix<std::complex<Real>, 3, 3> plant;   // P
    Eigen::Matrix<std::complex<Real>, 3, 3> centre;  // of it less the own shift, without that of the other aliases
    Eigen::Matrix<Real, 3, 3> left;                  // of the own alias, real part
    Eigen::Matrix<Real, 3, 3> right;
    Eigen::Matrix<std::complex<Real>, 3, 3> sensed;
    Eigen::Matrix<std::complex<Real>, 3, 3> pushed;
    Alias own;
    Others others;
  };
  // 0 < angle = w T <= pi. Below `low_angle` the free plant's own part is computed with the discs, its other aliases' part is that at
  // `low_angle`.
  static constexpr double low_angle = 1e-3;
  [[nodiscard]] Sample at(double angle) const;
  // Without the others.
  [[nodiscard]] Sample own_at(double angle) const;
  // 0 <= angle <= pi.
  [[nodiscard]] Others others_at(double angle) const;

  // sT at which R = 0, those with a positive imaginary part, of the lag and of a drive that tracks: the poles of all of the
  // frequency's own but `plant`.
  //
  //     S' [(l + K) D^-1 (l + K) - l D] S x = 0,   l = s^2,   M = 1,   S: the motions in which the tip stands still
  //
  // (s^2 + s D + K) g = t' and t (s^2 - s D + K)^-1 D g = 0. Where nothing damps some motion, D is taken a little larger.
  [[nodiscard]] std::vector<std::complex<double>> lossless_points() const;
  // sT of the free motions, those with a positive imaginary part.
  [[nodiscard]] std::vector<std::complex<double>> free_poles() const;

  // sT of the motions that are left where the tip stands still: a grasp that holds it so makes them the loop's own.
  [[nodiscard]] std::vector<std::complex<double>> still_poles() const;
  [[nodiscard]] Eigen::Index still_at_rest() const;

  // The least |sT| of those and of the lossless points, of what does not rest: as w -> 0 nothing changes far below it. Infinite where
  // there is none, 0 where rounding hides it.
  [[nodiscard]] double slowest_corner() const;

  // In how many the tip moves.
  [[nodiscard]] Eigen::Index directions() const { return of_.tip.rows(); }

  // Nothing dissipates some motion of the tip: some grasp destabilises any wall.
  [[nodiscard]] bool is_undamped() const { return undamped_; }

 private:
  [[nodiscard]] Alias alias(double frequency) const;
  void add_own(Sample& sample) const;
  // (P/shared - own shift) below low_angle, and both forms.
  void add_low(Sample& sample) const;
  [[nodiscard]] Eigen::MatrixXd still_motions() const;

  TipCoordinates of_;
  TipResponse response_;
  double period_ = 0.0;
  double delay_ = 0.0;
  DrivePath drive_;
  Eigen::MatrixXd basis_;                                     // of the tip's motions, orthonormal rows
  Eigen::MatrixXd dampers_;                                   // F
  Eigen::Matrix3cd others_plant_ = Eigen::Matrix3cd::Zero();  // P/shared - own G/(jw) at low_angle
  bool undamped_ = false;
  AliasSumQuadrature rule_;
};

// n_x^2, n_y^2, n_z^2, n_x n_y, n_x n_z, n_y n_z.
[[nodiscard]] Eigen::Matrix<double, 6, 1> products_of(const Eigen::Vector3d& normal);
// The real or imaginary part of n' form n by those.
template <typename Form>
[[nodiscard]] Eigen::Matrix<typename Form::Scalar, 1, 6> by_products(const Eigen::MatrixBase<Form>& form) {
  Eigen::Matrix<typename Form::Scalar, 1, 6> row;
  row << form(0, 0), form(1, 1), form(2, 2), form(0, 1) + form(1, 0), form(0, 2) + form(2, 0), form(1, 2) + form(2, 1);
  return row;
}

}  // namespace zwidth::internal
