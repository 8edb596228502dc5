#pragma once

#include <Eigen/Core>
#include <vector>

#include "identification/model/device_family.hpp"
#include "identification/model/row_sums.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// [A b c_0 ... c_n-1] of x' = A x + b u + sum_j c_j f_j: x = (q_0, q_i - q_0, v_i, lagged force), u the commanded force, f_j one
/// on each body. Positions are relative to body 0, so that a link's small extension keeps its digits.
[[nodiscard]] Eigen::MatrixXd motion_columns(const Device& device);

/// d motion_columns / dx by the family's numbers of the device, by central differences: to 1e-9.
[[nodiscard]] std::vector<Eigen::MatrixXd> motion_slopes(const DeviceFamily& family, const Eigen::VectorXd& x);

/// The linear device over a time of constant forces, exactly: x -> [e^{Ah} B C] (x, u, f).
struct LinearStep {
  Rows columns;
  Rows slopes;  ///< d columns / dx, a row per element, column by column; a column per number of the device, padded
  double length = 0.0;  ///< s
};
[[nodiscard]] LinearStep linear_step(const Eigen::MatrixXd& columns, const std::vector<Eigen::MatrixXd>& slopes,
                                     double length);

}  // namespace zwidth::internal
