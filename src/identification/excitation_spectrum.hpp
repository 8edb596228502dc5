#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace zwidth::internal {

/// A band of frequencies as fractions of the rate: 0 < lowest <= highest <= 0.5.
struct RelativeBand {
  double lowest = 0.0;
  double highest = 0.0;
};

/// One period of a sum of cosines of equal amplitude at every line k/size in the band (below Nyquist), with Schroeder's
/// phases for a low crest factor. Throws Error (invalid_argument) where the band holds no line, or size is above
/// max_transformed_samples. Source: Schroeder 1970, eq. 11.
[[nodiscard]] std::vector<double> schroeder_multisine(std::size_t size, RelativeBand band);

/// Gaussian noise of constant power density in the band and none outside. Requires and throws as above.
[[nodiscard]] std::vector<double> band_limited_noise(std::size_t size, RelativeBand band, std::uint64_t seed);

}  // namespace zwidth::internal
