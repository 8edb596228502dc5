#pragma once

#include <string>

#include "results/json.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(LoopVerdict, {{LoopVerdict::undecided, "undecided"},
                                           {LoopVerdict::settles, "settles"},
                                           {LoopVerdict::limit_cycle, "limit_cycle"},
                                           {LoopVerdict::forced, "forced"},
                                           {LoopVerdict::unstable, "unstable"},
                                           {LoopVerdict::drifts, "drifts"}})
NLOHMANN_JSON_SERIALIZE_ENUM(NonlinearPart, {{NonlinearPart::coulomb_friction, "coulomb_friction"},
                                             {NonlinearPart::quantisation_step, "encoder_step"},
                                             {NonlinearPart::force_limit, "force_limit"},
                                             {NonlinearPart::leaving_wall, "leaving_wall"},
                                             {NonlinearPart::lost_samples, "lost_samples"},
                                             {NonlinearPart::sampling_jitter, "sampling_jitter"},
                                             {NonlinearPart::late_forces, "late_forces"}})

/// The document of `simulate --json`, schema zwidth.simulation/1, keys in their documented order. What does not exist
/// is null; NaN and infinities never appear. The points are those that were kept: none without keep_every.
[[nodiscard]] Json simulation_json(const Device& device, const Simulation& result,
                                   PointsInJson points = PointsInJson::left_out);

/// The kept points of the run as comma-separated values with a header: time_s, measured, command, user_force, then
/// position and velocity of every body ("handle.position"), of a transfer function its output, and trust. SI units and
/// radians.
[[nodiscard]] std::string simulation_csv(const Device& device, const Simulation& result);

}  // namespace zwidth::results
