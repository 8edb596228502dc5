#pragma once

#include <string>

#include "results/json.hpp"
#include "zwidth/simulation/relay.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(LimitReading, {{LimitReading::none, "none"},
                                            {LimitReading::confirms, "confirms"},
                                            {LimitReading::coincides, "coincides"},
                                            {LimitReading::unsafe, "unsafe"},
                                            {LimitReading::too_cautious, "too_cautious"}})
NLOHMANN_JSON_SERIALIZE_ENUM(RelayResult::Source, {{RelayResult::Source::simulation, "simulation"},
                                                   {RelayResult::Source::recording, "recording"}})

/// The document of `relay --json`, schema zwidth.relay/1: trials, their mean, predictions, explanation, trust, remarks.
/// What does not exist is null.
[[nodiscard]] Json relay_json(const RelayResult& result);

/// "time_s,force_1,position_1,force_2,...,trust": the records of all trials side by side, 17 significant digits.
[[nodiscard]] std::string relay_csv(const RelayResult& result);

}  // namespace zwidth::results
