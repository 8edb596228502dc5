#pragma once

#include "results/json.hpp"
#include "zwidth/stability/force_per_count.hpp"

namespace zwidth::results {

/// "stiffness" (K q), "damping" (B (1 - a) q / T), "largest".
inline void to_json(Json& json, const ForcePerCount& force) {
  json = {{"stiffness", force.stiffness}, {"damping", force.damping}, {"largest", force.largest}};
}

}  // namespace zwidth::results
