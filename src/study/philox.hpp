#pragma once

#include <array>
#include <cstdint>

namespace zwidth::internal {

/// Philox 4x32-10: 128 random bits that are a function of a counter and a key alone.
///
/// Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011,
/// section 3.3, and its known answers (Random123, kat_vectors).
[[nodiscard]] constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                            std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t second = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(second >> 32U) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
               static_cast<std::uint32_t>(first >> 32U) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key = {key[0] + 0x9E3779B9U, key[1] + 0xBB67AE85U};
  }
  return counter;
}

/// The k-th 64 random bits of a stream: streams are numbered so that no two uses of one seed share any.
[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint32_t stream, std::uint64_t k) {
  const std::uint64_t block = k / 2;
  const auto bits = philox({static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32U), stream, 0},
                           {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)});
  return k % 2 == 0 ? bits[0] | std::uint64_t{bits[1]} << 32U : bits[2] | std::uint64_t{bits[3]} << 32U;
}

/// In least_uniform..1 - least_uniform, of 52 bits: (k + 1/2) 2^-52.
[[nodiscard]] constexpr double uniform_of(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12U) + 0.5) * 0x1p-52;
}

}  // namespace zwidth::internal
