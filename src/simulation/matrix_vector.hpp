#pragma once

#include <cstddef>

namespace zwidth::internal {

/// y = A x, A square and column by column. The size is compiled in for the small matrices that a simulation steps with.
using MatrixVector = void (*)(const double* matrix, const double* x, double* y, std::size_t size) noexcept;

[[nodiscard]] MatrixVector matrix_vector(std::size_t size);

/// y = M x of the first rows and columns of a matrix, by columns of `stride` entries; x and y do not overlap.
using MatrixPartVector = void (*)(const double* matrix, const double* x, double* y, std::size_t rows,
                                  std::size_t columns, std::size_t stride) noexcept;

[[nodiscard]] MatrixPartVector matrix_part_vector(std::size_t rows);

}  // namespace zwidth::internal
