#pragma once

#include "results/json.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(StiffnessStatus, {{StiffnessStatus::finite, "finite"},
                                               {StiffnessStatus::none_stable, "none_stable"},
                                               {StiffnessStatus::unbounded, "unbounded"},
                                               {StiffnessStatus::refused, "refused"}})
NLOHMANN_JSON_SERIALIZE_ENUM(RigidApproximation::Error, {{RigidApproximation::Error::none, "none"},
                                                         {RigidApproximation::Error::safe, "safe"},
                                                         {RigidApproximation::Error::unsafe, "unsafe"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Oscillator::Kind, {{Oscillator::Kind::rigid_body, "rigid_body"},
                                                {Oscillator::Kind::vibration_mode, "vibration_mode"}})

NLOHMANN_JSON_SERIALIZE_ENUM(WallStability, {{WallStability::anyone, "anyone"},
                                             {WallStability::alone_only, "alone_only"},
                                             {WallStability::unstable, "unstable"}})

NLOHMANN_JSON_SERIALIZE_ENUM(Holder,
                             {{Holder::nobody, "nobody"}, {Holder::user, "user"}, {Holder::any_user, "any_user"}})

/// {"kind": "rigid_body"} or {"kind": "vibration_mode", "mode": 1}
void to_json(Json& json, const Oscillator& oscillator);

/// "frequency_rad_s", "frequency_hz", "stiffness", "stiffness_db", "limited_by", "poles_leaving"
void to_json(Json& json, const Crossover& crossover);

/// [lower, upper]; an unbounded end is null.
void to_json(Json& json, const StableInterval& interval);
void to_json(Json& json, const StiffnessInterval& interval);

/// "frequency_rad_s", "frequency_hz", "damping_ratio"
void to_json(Json& json, const Mode& mode);

void to_json(Json& json, const RigidApproximation& rigid);
void to_json(Json& json, const QCriterion& criterion);
void to_json(Json& json, const WallMargins& wall);
void to_json(Json& json, const DiskMargin& disk);
void to_json(Json& json, const WorstUser& worst);

/// "critical_stiffness", "frequency_rad_s", "limited_by", "critical_damping", "critical_damping_frequency_rad_s",
/// "critical_damping_limited_by"
void to_json(Json& json, const HolderLimit& limit);

/// {"nobody": {...}, "user": {...} | null, "any_user": {...} | null}: `limits` of every document that states one
/// (holding_limits()).
void to_json(Json& json, const HoldingLimits& limits);

/// {"nobody": bool, "user": bool | null, "any_user": bool | null}: `stable_for` of a wall
void to_json(Json& json, const StableFor& wall);

/// "status", "critical_stiffness", "critical_stiffness_db", "critical_frequency_rad_s", "critical_frequency_hz",
/// "limited_by": the keys with which a document states a critical stiffness.
void add_critical(Json& document, const CriticalStiffness& critical);

}  // namespace zwidth::results
