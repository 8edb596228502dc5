#include "uff_function_name.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace zwidth::internal {

std::string uff_function_name(int function_type) {
  constexpr std::array<std::string_view, 29> names{"function of unknown type",
                                                   "time response",
                                                   "auto spectrum",
                                                   "cross spectrum",
                                                   "frequency response",
                                                   "transmissibility",
                                                   "coherence",
                                                   "auto correlation",
                                                   "cross correlation",
                                                   "power spectral density",
                                                   "energy spectral density",
                                                   "probability density",
                                                   "spectrum",
                                                   "cumulative frequency distribution",
                                                   "peaks and valleys",
                                                   "stress and cycles",
                                                   "strain and cycles",
                                                   "orbit",
                                                   "mode indicator function",
                                                   "force pattern",
                                                   "partial power",
                                                   "partial coherence",
                                                   "eigenvalue",
                                                   "eigenvector",
                                                   "shock response spectrum",
                                                   "impulse response filter",
                                                   "multiple coherence",
                                                   "order function",
                                                   "phase compensation"};
  const auto index = static_cast<std::size_t>(function_type);
  return function_type >= 0 && index < names.size() ? std::string(names[index])
                                                    : fmt::format("function of type {}", function_type);
}

}  // namespace zwidth::internal
