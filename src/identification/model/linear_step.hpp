#pragma once

#include <Eigen/Core>
#include <vector>

#include "identification/model/number.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// x' = A x + b u + sum_j c_j f_j, x = (q_0, q_i - q_0, v_i, lagged force): u the commanded force, f_j one on each body.
///
/// One matrix [A b c_0 ... c_n-1], rows as many as x has. Positions are relative to body 0, so that a link's small extension
/// keeps its digits.
[[nodiscard]] Eigen::MatrixXd motion_columns(const Device& device);

/// d motion_columns / d value of a number of the device, of the device in the experiment: `locked` bodies are held still. Zero
/// for a delay. A is affine in each number, or in the inverse of a mass or a lag.
[[nodiscard]] Eigen::MatrixXd motion_columns_slope(const DeviceParameters& parameters, const std::string& key, double unit,
                                                   const std::vector<std::string>& locked);

/// The linear device over a step of constant forces, exactly: x -> e^{Ah} x + B u + sum_j C_j f_j in one matrix
/// [e^{Ah} B C], with its derivatives.
struct LinearStep {
  Eigen::MatrixXd columns;
  std::vector<Eigen::MatrixXd> slopes;  ///< one per given slope of motion_columns
};
[[nodiscard]] LinearStep linear_step(const Eigen::MatrixXd& columns, const std::vector<Eigen::MatrixXd>& slopes,
                                     double length);

}  // namespace zwidth::internal
