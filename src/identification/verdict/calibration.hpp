#pragma once

#include <Eigen/Core>
#include <array>

namespace zwidth::internal {

/// The constants of the verdict, with how each was got.
struct Calibration {
  // CALIBRATION
  /// Below this p-value what is left stands out.
  static constexpr double least_p = 1e-4;
  /// Of the upper end of the critical stiffness's interval to the lower: above, the interval is too wide.
  static constexpr double widest_interval = 1.5;
  /// The portmanteau's largest lag, samples: about twice the order of the noise's filter.
  static constexpr Eigen::Index most_lags = 50;
  /// Lags of the force whose correlation with the residuals is tested, samples; below 0 the force follows the motion. Dense
  /// where a response begins, a factor of about 1.4 apart later: neighbours there tell the same of a smooth force.
  static constexpr std::array<int, 16> force_lags = {-5, -2, -1, 0, 1, 2, 3, 5, 7, 10, 14, 20, 30, 45, 70, 100};
  /// Rounding is noise where the record moves by so many encoder steps within so many samples.
  static constexpr double least_steps = 3.5;
  static constexpr Eigen::Index moving_within = 64;
  /// A direction that the fitted ones explain up to this share of its size says nothing of its own.
  static constexpr double least_share = 1e-3;
};

}  // namespace zwidth::internal
