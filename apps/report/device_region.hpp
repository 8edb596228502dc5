#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysed_device.hpp"
#include "zwidth/design/any_user_region.hpp"
#include "zwidth/design/region_approximation.hpp"
#include "zwidth/design/stable_region.hpp"

namespace zwidth::report {

/// A formula of the literature beside the exact region.
struct ComparedApproximation {
  RegionApproximation formula;
  ApproximationError error;
};

/// A device with its stable walls, the input of every report of a region.
struct DeviceRegion {
  AnalysedDevice analysed;  ///< without the any-user limit
  StableWalls walls;        ///< with the file's velocity filter
  StableRegion region;
  /// Absent for a transfer function, above most_bodies_for_any_user, or where no wall is stable.
  std::optional<AnyUserRegion> any_user;
  std::vector<ComparedApproximation> approximations;  ///< none for a transfer function
};

/// The region of the device, with the velocity filter of its [wall]. Throws Error (did_not_converge) as its parts do.
[[nodiscard]] DeviceRegion device_region(Device device);

/// "colgate_schenkel".
[[nodiscard]] const char* formula_key(RegionApproximation::Formula formula);

/// "Colgate & Schenkel".
[[nodiscard]] std::string formula_name(RegionApproximation::Formula formula);

/// "Colgate & Schenkel 1997".
[[nodiscard]] const char* formula_source(RegionApproximation::Formula formula);

/// "b > K T/2 + B".
[[nodiscard]] const char* formula_text(RegionApproximation::Formula formula);

/// What the formula is made for.
[[nodiscard]] const char* formula_validity(RegionApproximation::Formula formula);

/// What of that the device is not: "flexible links", "a delay", ... Empty where the formula holds.
[[nodiscard]] std::vector<std::string> unmet_assumptions(RegionApproximation::Formula formula, const Device& device);

/// "oscillation", "nyquist", "drift", "no_stiffness", "no_damping".
[[nodiscard]] const char* boundary_key(BoundaryKind kind);

}  // namespace zwidth::report
