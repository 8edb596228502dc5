#pragma once

#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "io/byte_order.hpp"
#include "io/mat_contents.hpp"

namespace zwidth::internal {

/// A data element of a MAT file of version 5: a tag and the bytes that it announces.
struct Mat5Element {
  unsigned type = 0;
  std::span<const unsigned char> bytes;
};

/// Types of elements that hold others.
inline constexpr unsigned mat5_matrix = 14;
inline constexpr unsigned mat5_compressed = 15;

/// Takes the element at the front of `rest`. Refused: one that goes past the end.
[[nodiscard]] tl::expected<Mat5Element, Problem> take_mat5_element(std::span<const unsigned char>& rest,
                                                                   ByteOrder order);

/// What a matrix element holds: the arrays in it and, for each, the element of its numbers.
struct Mat5Matrix {
  MatContents contents;
  std::vector<Mat5Element> numbers;  ///< one per contents.arrays
};

/// Walks through a matrix element with all that is in it (structs). Every size is checked against the bytes that are
/// there. Refused: sizes that contradict each other. `bytes` are those after the element's tag.
/// Source: MathWorks, MAT-File Format, chapter 1 (level 5).
[[nodiscard]] tl::expected<Mat5Matrix, Problem> read_mat5_matrix(std::span<const unsigned char> bytes, ByteOrder order);

/// The numbers of an element that read_mat5_matrix() has found.
[[nodiscard]] std::vector<double> mat5_numbers(const Mat5Element& element, ByteOrder order);

}  // namespace zwidth::internal
