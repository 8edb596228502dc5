#pragma once

#include "results/json.hpp"
#include "zwidth/rig/results.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(StopReason, {{StopReason::none, nullptr},
                                          {StopReason::interrupted, "interrupted"},
                                          {StopReason::not_a_number, "not_a_number"},
                                          {StopReason::position_limit, "position_limit"},
                                          {StopReason::velocity_limit, "velocity_limit"},
                                          {StopReason::saturation, "saturation"},
                                          {StopReason::missed_cycles, "missed_cycles"},
                                          {StopReason::lost_link, "lost_link"},
                                          {StopReason::watchdog, "watchdog"},
                                          {StopReason::oscillation, "oscillation"},
                                          {StopReason::wrong_sign, "wrong_sign"},
                                          {StopReason::unknown_sign, "unknown_sign"}})
NLOHMANN_JSON_SERIALIZE_ENUM(NudgeReading, {{NudgeReading::with_force, "with_force"},
                                            {NudgeReading::against_force, "against_force"},
                                            {NudgeReading::not_told, "not_told"}})

// The documents of `rig ACTION --json`, schema "zwidth.rig_ACTION/1": see docs/rig_method.md.
[[nodiscard]] Json rig_json(const Device& device, const RigCheck& check);
[[nodiscard]] Json rig_json(const Device& device, const RigMeasurement& measurement);
[[nodiscard]] Json rig_json(const Device& device, const RigIdentification& identification);
[[nodiscard]] Json rig_json(const Device& device, const RigRelay& relay);
[[nodiscard]] Json rig_json(const Device& device, const RigWall& wall);
[[nodiscard]] Json rig_json(const Device& device, const RigLimit& limit);

}  // namespace zwidth::results
