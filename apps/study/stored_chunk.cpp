#include "study/stored_chunk.hpp"

#include <zlib.h>

#include <cstdint>
#include <stdexcept>

namespace zwidth::study_engine {
namespace {

/// J. G. Fletcher, IEEE Trans. Commun. 30, 247 (1982), over words of two bytes, the high one first; modulo 65535.
std::uint32_t fletcher_32(const StoredChunk& bytes) {
  std::uint64_t sum = 0;
  std::uint64_t sum_of_sums = 0;
  constexpr std::size_t most_words = 1U << 16U;  // between two reductions: the sums stay below 2^64
  const auto fold = [](std::uint64_t& value) {
    while (value > 0xffff) value = (value & 0xffff) + (value >> 16U);
  };
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const std::uint64_t low = i + 1 < bytes.size() ? bytes[i + 1] : 0U;
    sum += std::uint64_t{bytes[i]} << 8U | low;
    sum_of_sums += sum;
    if (i / 2 % most_words == most_words - 1) fold(sum), fold(sum_of_sums);
  }
  fold(sum), fold(sum_of_sums);
  return static_cast<std::uint32_t>(sum_of_sums << 16U | sum);
}

}  // namespace

StoredChunk stored_chunk(const void* elements, std::size_t size, std::size_t count, std::size_t capacity) {
  const auto* bytes = static_cast<const unsigned char*>(elements);
  StoredChunk shuffled(size * capacity, 0);  // the first bytes of all elements, the second ones, ...
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < size; ++j) shuffled[j * capacity + i] = bytes[i * size + j];
  }
  uLongf length = compressBound(shuffled.size());
  StoredChunk stored(length);
  if (compress2(stored.data(), &length, shuffled.data(), shuffled.size(), deflate_level) != Z_OK) {
    throw std::runtime_error("zlib cannot compress");
  }
  stored.resize(length);
  const std::uint32_t checksum = fletcher_32(stored);
  for (unsigned shift = 0; shift < 32; shift += 8) {
    stored.push_back(static_cast<unsigned char>(checksum >> shift & 0xffU));
  }
  return stored;
}

}  // namespace zwidth::study_engine
