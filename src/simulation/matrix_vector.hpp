#pragma once

#include <cstddef>

namespace zwidth::internal {

/// y = A x, A square and column by column. The size is compiled in for the small matrices that a simulation steps with.
using MatrixVector = void (*)(const double* matrix, const double* x, double* y, std::size_t size) noexcept;

[[nodiscard]] MatrixVector matrix_vector(std::size_t size);

}  // namespace zwidth::internal
