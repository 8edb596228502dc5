#include "model/balance.hpp"

#include <cmath>

namespace zwidth::internal {

Eigen::VectorXd balancing_scales(const Eigen::MatrixXd& matrix) {
  constexpr int max_sweeps = 100;
  constexpr double worth_scaling = 0.95;  // as LAPACK: a chain of delays would be moved by factors of 2 for ever
  const Eigen::Index n = matrix.rows();
  Eigen::MatrixXd m = matrix.cwiseAbs();
  m.diagonal().setZero();
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(n);
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    bool changed = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double column = m.col(i).sum();
      const double row = m.row(i).sum();
      if (column == 0.0 || row == 0.0) continue;
      if (row < 2.0 * column && column < 2.0 * row) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (!(column * factor + row / factor < worth_scaling * (column + row))) continue;
      m.col(i) *= factor;
      m.row(i) /= factor;
      scales(i) *= factor;
      changed = true;
    }
    if (!changed) break;
  }
  return scales;
}

}  // namespace zwidth::internal
