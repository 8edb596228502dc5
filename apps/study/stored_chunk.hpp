#pragma once

#include <cstddef>
#include <vector>

namespace zwidth::study_engine {

using StoredChunk = std::vector<unsigned char>;

/// A chunk as HDF5 keeps it behind its filters shuffle, deflate (level 1) and Fletcher-32, in this order, so that threads
/// can compress while one writes: `count` elements of `size` bytes, and zeros up to `capacity` elements.
[[nodiscard]] StoredChunk stored_chunk(const void* elements, std::size_t size, std::size_t count, std::size_t capacity);

inline constexpr unsigned deflate_level = 1;  // random numbers hardly compress; the first level takes what there is

}  // namespace zwidth::study_engine
