#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace zwidth::internal {

/// The bytes that a zlib stream holds. Memory grows with what comes out, never with what the stream claims.
/// Refused, saying why: a damaged or unfinished stream, and one of more than `limit` bytes.
[[nodiscard]] tl::expected<std::vector<unsigned char>, std::string> inflate_all(std::span<const unsigned char> stream,
                                                                                std::size_t limit);

}  // namespace zwidth::internal
