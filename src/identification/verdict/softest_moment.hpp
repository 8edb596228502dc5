#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "identification/fit/minimise.hpp"

namespace zwidth::internal {

/// When the limit of a device is asked that drifts while it is recorded: shares of the record, 0 its beginning, 1 its end.
struct LimitMoments {
  double softest = 0.5;  ///< where the least limit is lowest: the lower end of the interval is of it
  double likely = 0.5;   ///< between that and the middle, as far as the drift is known: the value and the upper end
};

/// The softer end of the record at a minimum, and how far towards it the drift is more than chance:
///
///     likely = 1/2 + max(0, 1 - 2 variance / fall^2) (softest - 1/2),  fall: log K of the middle less that of the softer end
///
/// Of two ends the softer is always below the middle, by chance too: Stein's shrinkage takes that away, and leaves a fall of
/// several deviations as it is. The lower end of an interval has all of it.
/// `log_limit`: of coordinates and a share; `first` to `last`: where the coordinates of the drifts are.
/// Nothing where there is no limit in the middle or at either end.
/// Source: James & Stein 1961, positive part.
[[nodiscard]] std::optional<LimitMoments> limit_moments(
    const std::function<std::optional<double>(const Eigen::VectorXd&, double)>& log_limit, const Minimum& minimum,
    Eigen::Index first, Eigen::Index last);

}  // namespace zwidth::internal
