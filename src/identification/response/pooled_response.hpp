#pragma once

#include <optional>
#include <span>
#include <vector>

#include "zwidth/identification/measured_response.hpp"

namespace zwidth::internal {

/// One response from several records of one device, line by line. With w = n |F|^2 (n averages of the force F), which is
/// 1 / variance at equal noise,
///
///     H = sum w_r H_r / sum w_r,  variance = sum w_r^2 v_r / (sum w_r)^2
///
/// and the degrees of freedom of that sum (Satterthwaite's) as averages. Where the records differ by more than their
/// noise the variance is that of H between them, where it is larger. Records of other rates count as if the force had been
/// held for the first one's period; lines within 2 % of their spacing are one.
struct PooledResponse {
  FrequencyResponse response;
  std::optional<AmplitudeDependence> dependence;
};
[[nodiscard]] PooledResponse pooled_response(std::span<const FrequencyResponse> measured);

/// The response of each recording, estimated so that their lines meet; defined beside frequency_response() of them,
/// which says what is refused.
[[nodiscard]] std::vector<FrequencyResponse> responses(std::span<const Recording> recordings,
                                                       const FrequencyResponseOptions& options,
                                                       const Progress& progress = {});

}  // namespace zwidth::internal
