#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// A band of frequencies as fractions of the rate: 0 < lowest <= highest <= 0.5.
struct RelativeBand {
  double lowest = 0.0;
  double highest = 0.0;
};

/// Why a signal of `size` samples cannot be made of the lines in the band: it holds none, or one transform would be
/// larger than max_transformed_samples.
[[nodiscard]] std::optional<OptionProblem> find_problem(std::size_t size, RelativeBand band);

/// One period of a sum of cosines of equal amplitude at every line k/size in the band (below Nyquist), with Schroeder's
/// phases for a low crest factor. Requires that find_problem(size, band) finds none.
/// Source: Schroeder 1970, eq. 11.
[[nodiscard]] std::vector<double> schroeder_multisine(std::size_t size, RelativeBand band);

/// Gaussian noise of constant power density in the band and none outside. Requires the same.
[[nodiscard]] std::vector<double> band_limited_noise(std::size_t size, RelativeBand band, std::uint64_t seed);

}  // namespace zwidth::internal
