#pragma once

#include <string>

#include "results/json.hpp"
#include "zwidth/stability/bode.hpp"

namespace zwidth::results {

/// The document of `bode --json`, schema zwidth.bode/1, keys in their documented order.
[[nodiscard]] Json bode_json(const Device& device, const Bode& bode);

/// "frequency_rad_s,frequency_hz,magnitude_db,phase_deg,continuous_magnitude_db,continuous_phase_deg,trust": the
/// sampled response first. A cell above Nyquist is empty. Numbers carry 17 significant digits.
[[nodiscard]] std::string bode_csv(const Bode& bode);

}  // namespace zwidth::results
