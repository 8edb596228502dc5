#pragma once

#include <Eigen/Core>
#include <array>

namespace zwidth::internal {

/// The constants of the verdict, with how each was got.
struct Calibration {
  /// Below this p-value what is left stands out.
  ///
  /// Simulated records that the model explains: one body of 0.1 to 0.5 kg and 0.2 to 1.7 N s/m, 3 s at 1 kHz under 2 N from 1 to
  /// 200 Hz, filter of order 24, 100 records a row. Percent with the combined p below 0.1, 0.01, 0.001 and the largest excess:
  ///
  ///     sweep, encoder step 1e-6 m, noise 1e-5 m        3  1  0   6.1
  ///     sweep, encoder step 1e-5 m, noise 3e-6 m        5  1  0   5.3
  ///     sweep, encoder step 1e-5 m, no noise            9  0  0   3.9
  ///     sweep, encoder step 1e-4 m, no noise            6  1  0   7.3   (all rows counted: 73 71 63)
  ///     three periods, encoder step 1e-5 m, no noise    4  0  0   3.2
  ///
  /// No p of any was below 1e-4. Records of the same bodies with 1e-5 m of noise and what the model lacks, four each: a body of
  /// 5 % at 60 Hz gave p = 7e-3 to 3e-18, drag of 0.3 of the damping per m/s 1e-2 to 2e-14, friction of 1 % of the force 2e-4 to
  /// 3e-8.
  static constexpr double least_p = 1e-4;
  /// Of the upper end of the critical stiffness's interval to the lower: above, the interval is too wide.
  static constexpr double widest_interval = 1.5;
  /// Lags of the force whose correlation with the residuals is tested, samples; below 0 the force follows the motion. Dense
  /// where a response begins, a factor of about 1.4 apart later: neighbours there tell the same of a smooth force.
  static constexpr std::array<int, 16> force_lags = {-5, -2, -1, 0, 1, 2, 3, 5, 7, 10, 14, 20, 30, 45, 70, 100};
  /// Rounding is noise where the record moves by so many encoder steps within so many samples.
  static constexpr double least_steps = 3.5;
  static constexpr Eigen::Index moving_within = 64;
  /// Parts of a segment, and of its spectrum, whose shares in the limit are taken as independent.
  static constexpr int parts_of_limit = 16;
  /// Where phase and slope of a response agree this little or less, its sign is turned. 130 records of the identification campaign
  /// (all kinds, seeds 1 and 2) have 0.41 to 1, 128 of them more than 0.66; turned, the same with a minus.
  static constexpr double turned_agreement = -0.3;
  /// A direction that the fitted ones explain up to this share of its size says nothing of its own.
  static constexpr double least_share = 1e-3;
};

}  // namespace zwidth::internal
