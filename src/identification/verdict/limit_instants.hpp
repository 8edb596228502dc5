#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "identification/model/device_family.hpp"
#include "identification/optimiser/minimise.hpp"

namespace zwidth::internal {

/// The instants of a record, 0 its beginning and 1 its end, at which the limit of a device is asked that drifts meanwhile. Each
/// drift by itself, the other in its middle: as near to the softer end, where the limit is lower, as this drift is more than
/// chance. So neither a drift that may be chance hides a clear one, nor one that stiffens one that softens.
///
///     1/2 + max(0, 1 - 3.84 variance / fall^2) (softer - 1/2),  fall: log K of the middle less that of the softer end
///
/// Of two ends one is softer than the middle by chance too: the middle is asked where no drift is within the fall's own 95 %,
/// nearly the end where the fall is many deviations.
/// `log_limit`: of coordinates and instants; `first` to `last`: where the coordinates of the drifts are.
/// Nothing where there is no limit in the middle or at either end of a drift.
/// Source: Breiman 1995, the garrote's shrinkage.
[[nodiscard]] std::optional<DriftInstants> limit_instants(
    const std::function<std::optional<double>(const Eigen::VectorXd&, const DriftInstants&)>& log_limit,
    const Minimum& minimum, Eigen::Index first, Eigen::Index last);

}  // namespace zwidth::internal
