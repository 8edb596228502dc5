#pragma once

#include <Eigen/Core>

namespace zwidth::internal {

/// Covariance of a least-squares solution whose residuals may be correlated in time and vary in size.
///
///     (X'X)^-1 (G_0 + sum_{l=1..L} (1 - l/(L+1)) (G_l + G_l')) (X'X)^-1 n/(n-p),  G_l = sum_t g_t g_{t-l}',  g_t = r_t
///     x_t
///
/// x_t: the rows of X, in time's order; r: the residuals. Never less than the classical covariance r'r/(n-p) (X'X)^-1
/// in any parameter's variance. Requires more rows than columns, and full rank. Source: Newey & West 1987; L by Andrews
/// 1991, eqs. 6.2, 6.4 (Bartlett's kernel), the largest that a column asks for.
[[nodiscard]] Eigen::MatrixXd covariance_with_correlated_residuals(const Eigen::MatrixXd& regressors,
                                                                   const Eigen::VectorXd& residuals);

}  // namespace zwidth::internal
