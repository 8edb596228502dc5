#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "identification/model/rivals/catalogue.hpp"
#include "identification/verdict/rival_table.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The most likely device with all that is known of it, whatever it was found from.
struct FoundDevice {
  DeviceParameters device;  ///< most likely; at its softest moment where it drifts
  BestNumbers best;
  std::vector<AddedRival> rivals = {};
  /// Of log K_CR, by the last step of the search or of an end of the interval that was stopped; 0: all came to rest.
  double last_change = 0.0;
};

/// What is said of each number that was free, in its own units; dry friction of more than two deviations as well.
[[nodiscard]] std::vector<ParameterEstimate> estimates_of(const FoundDevice& found);

/// Pairs whose correlation exceeds 0.95.
[[nodiscard]] std::vector<StrongCorrelation> correlations_of(const FoundDevice& found);

/// The keys that the data leave open, if any, as one combination.
[[nodiscard]] std::vector<UnidentifiableCombination> open_numbers_of(const FoundDevice& found);

/// The device as a file keeps it: rivals of less than two deviations are none; with the covariance of its free numbers, so wide
/// along the slope of the limit that the limit's interval by that covariance is the answer's:
///
///     C' = C + (s^2 - 1) C g g' C / (g' C g),   s: half of log(upper / lower) over 1.96 sqrt(g' C g)
[[nodiscard]] Device device_of(const FoundDevice& found);

}  // namespace zwidth::internal
