#pragma once

#include <optional>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {

/// What can be read off a measured response without a model.
struct ResponseFeatures {
  std::vector<double> resonances;      ///< rad/s, by rising frequency: peaks of w^2 |P|
  std::vector<double> antiresonances;  ///< rad/s: dips of it
  double inertia_below = 0.0;          ///< 1 / (w^2 |P|) at the lowest frequencies: a free device's whole mass
  double inertia_above = 0.0;          ///< the same at the highest: the mass of the actuated body, where it is sensed
  double stiffness_below = 0.0;        ///< 1 / |P| at the lowest frequencies: of a device tied to ground
  /// s: the slope of the phase, whatever the resonances do: half the period, delay and lag together.
  double delay = 0.0;
  bool has_all_modes = false;  ///< the resonances are all that there are, from a fit and what it left
};

/// s: half of what the closest lines leave open, 2 pi / spacing; a longer delay is another one by an alias.
[[nodiscard]] double longest_resolved_delay(const std::vector<ResponsePoint>& points);

/// Requires at least one point.
[[nodiscard]] ResponseFeatures response_features(const std::vector<ResponsePoint>& points);

/// Some `most` of the points, evenly over the logarithm of frequency, with every resonance and antiresonance.
[[nodiscard]] std::vector<ResponsePoint> thinned(const std::vector<ResponsePoint>& points,
                                                 const ResponseFeatures& features, std::size_t most);

}  // namespace zwidth::internal
