#pragma once

#include <Eigen/Core>

namespace zwidth::internal {

// Functions, so that each of Eigen's solvers is compiled once: they take a compiler two to five seconds wherever they
// are used.

/// Relative to the largest pivot: what rounding leaves of columns that depend on others.
inline constexpr double smallest_pivot = 4e-15;

/// x of M x = b by LU factors with partial pivoting. M is regular.
Eigen::VectorXd solve(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// x of M x = b by LU factors with complete pivoting.
Eigen::VectorXd solve_pivoted(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::VectorXcd solve_complex(const Eigen::MatrixXcd& matrix, const Eigen::VectorXcd& right);

/// X of M X = B by LU factors with partial pivoting. M is regular.
Eigen::MatrixXcd solve_complex_columns(const Eigen::MatrixXcd& matrix, const Eigen::MatrixXcd& right);

/// x of M x = b by L D L^T. M is symmetric; its lower triangle is read.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// By LU factors with complete pivoting.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& matrix);

/// By L D L^T, of a symmetric matrix; its lower triangle is read.
Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& matrix);

/// x of least |M x - b|, or one for each column.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd least_squares_of_columns(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// x of least |M x - b|, the shortest where M lacks rank, and the length of each row of M's pseudo-inverse: the
/// standard deviation of that unknown where the entries of b are independent and of deviation 1.
struct ShortestSolution {
  Eigen::VectorXd solution;
  Eigen::VectorXd deviations;
};
ShortestSolution shortest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// The columns less their least-squares share in the span of the matrix's, whose rank counts the pivots above
/// `rank_tolerance` of the largest.
Eigen::MatrixXd outside_span(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& matrix, double rank_tolerance);

/// Orthonormal columns that span the matrix's, of which the rank counts the pivots above `rank_tolerance` of the largest.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& matrix, double rank_tolerance);

/// Orthonormal columns that span all that the matrix's do not, with the same rank.
Eigen::MatrixXd orthonormal_complement(const Eigen::MatrixXd& matrix, double rank_tolerance);

/// How many pivots of the columns are above `rank_tolerance` of the largest.
Eigen::Index rank(const Eigen::MatrixXd& matrix, double rank_tolerance);

/// X of least |M X - B|, the shortest where M lacks rank, by a complete orthogonal decomposition; the same rank.
Eigen::MatrixXd shortest_solutions(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right, double rank_tolerance);

/// Orthonormal columns that span those of the matrix whose pivots are above `least`.
Eigen::MatrixXd basis_above(const Eigen::MatrixXd& matrix, double least);

/// (M^T M)^{-1}. M has full rank.
Eigen::MatrixXd inverse_of_squares(const Eigen::MatrixXd& matrix);

/// Of a positive definite matrix.
Eigen::MatrixXd inverse_of_positive(const Eigen::MatrixXd& matrix);

/// L and L^{-1} of a positive definite matrix L L^T.
struct Cholesky {
  Eigen::MatrixXd lower;
  Eigen::MatrixXd inverse;
};
Cholesky cholesky(const Eigen::MatrixXd& matrix);

}  // namespace zwidth::internal
