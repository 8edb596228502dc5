#pragma once

#include <string>

#include "results/json.hpp"
#include "zwidth/design/region.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(WallRegion::Status, {{WallRegion::Status::bounded, "bounded"},
                                                  {WallRegion::Status::none_stable, "none_stable"},
                                                  {WallRegion::Status::unbounded, "unbounded"},
                                                  {WallRegion::Status::refused, "refused"}})
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

/// The boundary, a line per point: component by number, kind, K, B, rad/s, mode
/// (0: the rigid body; empty on K = 0 and B = 0), the verdict on all of it, and who holds the device: nobody, or the file's
/// user and then nobody.
[[nodiscard]] std::string region_csv(const WallRegion& walls);

/// A line per wall: K, B, 1 where it is stable with nobody and with the file's user, and the verdict on the region that it is a raster of.
[[nodiscard]] std::string region_raster_csv(const WallRaster& raster, const Trust& trust);

}  // namespace zwidth::results
