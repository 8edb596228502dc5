#pragma once

#include <Eigen/Core>

namespace zwidth::internal {

/// A matrix by its rows, each of a multiple of `lanes` columns: sums of rows go by so many columns at once.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
inline constexpr Eigen::Index lanes = 4;

/// So many columns, and zeros up to a multiple of `lanes`.
inline Eigen::Index padded(Eigen::Index columns) { return (columns + lanes - 1) / lanes * lanes; }

/// to += by from, of `width` columns, a multiple of `lanes`.
inline void add_row(double* __restrict to, double by, const double* __restrict from, Eigen::Index width) {
  for (Eigen::Index column = 0; column < width; column += lanes) {
    for (Eigen::Index lane = 0; lane < lanes; ++lane) to[column + lane] += by * from[column + lane];
  }
}

/// to += sum_j by[j] from[j], of `count` rows that begin `stride` numbers after each other.
void add_rows(double* to, const double* by, Eigen::Index count, const double* from, Eigen::Index stride,
              Eigen::Index width);

}  // namespace zwidth::internal
