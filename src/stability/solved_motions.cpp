#include "stability/solved_motions.hpp"

#include <Eigen/LU>

namespace zwidth::internal {

SolvedMotions::SolvedMotions(const Device& device, std::size_t forced)
    : matrices_(device_matrices<long double>(device)), forced_(forced) {}

void SolvedMotions::responses(double frequency, std::complex<double>* values) const {
  using Real = long double;
  using Number = std::complex<Real>;
  const Real w(frequency);
  const auto n = static_cast<Eigen::Index>(matrices_.mass.size());
  Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic> impedance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto entry = static_cast<std::size_t>(i * n + j);
      impedance(i, j) = {matrices_.stiffness[entry], w * matrices_.damping[entry]};
    }
    impedance(i, i) -= w * w * matrices_.mass[static_cast<std::size_t>(i)];
  }
  Eigen::Matrix<Number, Eigen::Dynamic, 1> force = Eigen::Matrix<Number, Eigen::Dynamic, 1>::Zero(n);
  force(static_cast<Eigen::Index>(forced_)) = Real(1.0);
  const Eigen::Matrix<Number, Eigen::Dynamic, 1> positions = impedance.partialPivLu().solve(force);
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    Number motion = positions(static_cast<Eigen::Index>(motions_[i].body));
    if (motions_[i].past != motions_[i].body) motion -= positions(static_cast<Eigen::Index>(motions_[i].past));
    values[i] = {static_cast<double>(motion.real()), static_cast<double>(motion.imag())};
  }
}

}  // namespace zwidth::internal
