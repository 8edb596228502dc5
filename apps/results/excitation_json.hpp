#pragma once

#include <functional>
#include <string_view>

#include "results/json.hpp"
#include "zwidth/identification/excitation.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(ExcitationKind, {{ExcitationKind::linear_chirp, "linear-chirp"},
                                              {ExcitationKind::logarithmic_chirp, "log-chirp"},
                                              {ExcitationKind::multisine, "multisine"},
                                              {ExcitationKind::noise, "noise"},
                                              {ExcitationKind::relay, "relay"}})

/// The document of `excite --json`, schema zwidth.excitation/1 (docs/excitation.md).
[[nodiscard]] Json excitation_json(const Excitation& excitation);

/// Hands the excitation to `sink` in pieces: a header time_s,force_N (of a rotary device torque_N_m) and one line per
/// sample, the force with nine digits.
void write_excitation_csv(const Excitation& excitation, const std::function<void(std::string_view)>& sink);

}  // namespace zwidth::results
