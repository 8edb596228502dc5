#pragma once

#include "results/json.hpp"
#include "zwidth/design/region.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(BoundaryKind, {{BoundaryKind::oscillation, "oscillation"},
                                            {BoundaryKind::nyquist, "nyquist"},
                                            {BoundaryKind::drift, "drift"},
                                            {BoundaryKind::no_stiffness, "no_stiffness"},
                                            {BoundaryKind::no_damping, "no_damping"}})
NLOHMANN_JSON_SERIALIZE_ENUM(RegionApproximation::Formula,
                             {{RegionApproximation::Formula::colgate_schenkel, "colgate_schenkel"},
                              {RegionApproximation::Formula::gil_hulin, "gil_hulin"},
                              {RegionApproximation::Formula::diolaiti, "diolaiti"}})

/// The answer of `region --json`, schema zwidth.region/1 (docs/region.md).
[[nodiscard]] Json region_json(const Device& device, const WallRegion& region);

}  // namespace zwidth::results
