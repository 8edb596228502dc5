#pragma once

#include <Eigen/Core>
#include <complex>
#include <limits>
#include <vector>

#include "stability/tip/posed_tip.hpp"
#include "stability/tip/tip_response.hpp"

namespace zwidth::internal {

// -1/P - B v over the unit circle, which is K where it is real; of every direction of a tip.
class CrossoverScan {
 public:
  explicit CrossoverScan(const PosedTip& posed);

  struct Found {
    double stiffness = std::numeric_limits<double>::infinity();
    double angle = 0.0;
  };
  [[nodiscard]] Found least_along(const Eigen::VectorXd& normal) const;

 private:
  [[nodiscard]] std::complex<double> stiffness(const Eigen::MatrixXcd& plant, double angle,
                                               const Eigen::VectorXd& normal) const;
  [[nodiscard]] Found crossover(const Eigen::VectorXd& normal, double a, std::complex<double> at_a, double b,
                                std::complex<double> at_b) const;

  VirtualDamper damper_;
  double period_;
  TipResponse response_;
  std::vector<double> angles_;
  std::vector<Eigen::MatrixXcd> samples_;
};

}  // namespace zwidth::internal
