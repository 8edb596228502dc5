#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "stability/tip/tip_states.hpp"

namespace zwidth::internal {

// C (delta - Phi)^-1 (Gamma1 + Gamma2 z^-1) z^-l on the unit circle: Phi is brought to Hessenberg form once, after which a
// frequency takes a few hundred products. Nothing is lost where poles coincide.
class TipResponse {
 public:
  explicit TipResponse(const SampledTip& plant);
  // At an angle w T in (0, pi]; m x m.
  [[nodiscard]] Eigen::MatrixXcd at(double angle) const;
  // z of its poles.
  [[nodiscard]] std::vector<std::complex<double>> poles() const;

 private:
  Eigen::MatrixXd hessenberg_;
  Eigen::MatrixXd output_;
  Eigen::MatrixXd input_;
  Eigen::MatrixXd late_input_;
  double delay_samples_ = 0.0;
};

// Angles where what has these poles changes fast: at and beside them.
[[nodiscard]] std::vector<double> angles_around(const std::vector<std::complex<double>>& poles);

}  // namespace zwidth::internal
