#pragma once

#include "results/json.hpp"
#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(WallGoal, {{WallGoal::stiffness, "stiffness"},
                                        {WallGoal::width, "width"},
                                        {WallGoal::critical_damping, "critical-damping"},
                                        {WallGoal::damper, "damper"}})
NLOHMANN_JSON_SERIALIZE_ENUM(WallBound, {{WallBound::none, "none"},
                                         {WallBound::any_user, "any_user"},
                                         {WallBound::gain_margin, "gain_margin"},
                                         {WallBound::phase_margin, "phase_margin"},
                                         {WallBound::quantisation_force, "ripple"},
                                         {WallBound::contact_damping, "contact_damping"},
                                         {WallBound::uncertainty, "uncertainty"},
                                         {WallBound::modal_frequency_uncertainty, "drift"}})
NLOHMANN_JSON_SERIALIZE_ENUM(WallRecommendation::Status, {{WallRecommendation::Status::found, "found"},
                                                          {WallRecommendation::Status::none, "none"},
                                                          {WallRecommendation::Status::unbounded, "unbounded"},
                                                          {WallRecommendation::Status::refused, "refused"}})

/// The answer of `design --recommend --json`, schema zwidth.wall_recommendation/1 (docs/recommendation.md).
[[nodiscard]] Json wall_recommendation_json(const Device& device, const RecommendationOptions& options,
                                            const WallRecommendation& recommendation);

}  // namespace zwidth::results
