#include "simulation/matrix_vector.hpp"

#include <array>
#include <utility>

namespace zwidth::internal {
namespace {

constexpr std::size_t largest_unrolled = 12;

template <std::size_t rows>
void multiply_part(const double* __restrict matrix, const double* __restrict x, double* __restrict y,
                   std::size_t /*rows*/, std::size_t columns, std::size_t stride) noexcept {
  double sum[rows];
  for (std::size_t i = 0; i < rows; ++i) sum[i] = matrix[i] * x[0];
  for (std::size_t j = 1; j < columns; ++j) {
    for (std::size_t i = 0; i < rows; ++i) sum[i] += matrix[j * stride + i] * x[j];
  }
  for (std::size_t i = 0; i < rows; ++i) y[i] = sum[i];
}

void multiply_any_part(const double* __restrict matrix, const double* __restrict x, double* __restrict y,
                       std::size_t rows, std::size_t columns, std::size_t stride) noexcept {
  for (std::size_t i = 0; i < rows; ++i) y[i] = 0.0;
  for (std::size_t j = 0; j < columns; ++j) {
    for (std::size_t i = 0; i < rows; ++i) y[i] += matrix[j * stride + i] * x[j];
  }
}

// The loops of a part, with all their ends known where it is compiled.
template <std::size_t size>
void multiply(const double* __restrict matrix, const double* __restrict x, double* __restrict y,
              std::size_t /*size*/) noexcept {
  multiply_part<size>(matrix, x, y, size, size, size);
}

void multiply_any(const double* __restrict matrix, const double* __restrict x, double* __restrict y,
                  std::size_t size) noexcept {
  multiply_any_part(matrix, x, y, size, size, size);
}

template <std::size_t... sizes>
constexpr std::array<MatrixPartVector, sizeof...(sizes)> part_table(std::index_sequence<sizes...>) {
  return {&multiply_part<sizes + 1>...};
}

template <std::size_t... sizes>
constexpr std::array<MatrixVector, sizeof...(sizes)> table(std::index_sequence<sizes...>) {
  return {&multiply<sizes + 1>...};
}

}  // namespace

MatrixVector matrix_vector(std::size_t size) {
  static constexpr auto unrolled = table(std::make_index_sequence<largest_unrolled>());
  return size >= 1 && size <= largest_unrolled ? unrolled[size - 1] : &multiply_any;
}

MatrixPartVector matrix_part_vector(std::size_t rows) {
  static constexpr auto unrolled = part_table(std::make_index_sequence<largest_unrolled>());
  return rows >= 1 && rows <= largest_unrolled ? unrolled[rows - 1] : &multiply_any_part;
}

}  // namespace zwidth::internal
