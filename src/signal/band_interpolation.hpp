#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace zwidth::internal {

/// Which signals an interpolation takes for likely.
struct SignalBand {
  double width = 0.0;  ///< rad per unit of place
  double noise = 0.0;  ///< variance of what is beside, over that of the band
};

/// Rows of a record, `first` up to before `end`.
struct RowRange {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// What the rows around a place count there; others count nothing.
struct RowWeights {
  RowRange before;  ///< rows of the first weights
  RowRange after;   ///< of the last ones
  Eigen::VectorXd weights;

  [[nodiscard]] double of(std::span<const double> signal) const;
};

/// Ordinary kriging from the nearest 16 rows: weights that sum to 1, of least error for a signal whose covariance at a
/// distance t is sin(width t)/(width t). `places` rise; the rows `without` are not used.
[[nodiscard]] RowWeights weights_around(std::span<const double> places, double at, SignalBand band,
                                        RowRange without = {});

}  // namespace zwidth::internal
