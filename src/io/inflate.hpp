#pragma once

#include <cstddef>
#include <span>
#include <tl/expected.hpp>
#include <vector>

namespace zwidth::internal {

enum class InflateFailure {
  too_large,  ///< more than the limit came out
  damaged,    ///< or unfinished
};

/// The bytes that a zlib stream holds. Memory grows with what comes out, never with what the stream claims.
/// Refused: a damaged or unfinished stream, and one of more than `limit` bytes.
[[nodiscard]] tl::expected<std::vector<unsigned char>, InflateFailure> inflate_all(
    std::span<const unsigned char> stream, std::size_t limit);

}  // namespace zwidth::internal
