#pragma once

#include <Eigen/Core>
#include <array>

namespace zwidth::internal {

/// The constants of the verdict, with how each was got.
struct Calibration {
  /// Below this p-value what is left stands out.
  ///
  /// Records of the identification campaign, seeds 1 and 2. 89 of 35 kinds that the model explains (one to three bodies, friction,
  /// drag, dead band, saturation, feedback, delay, lag): p below 0.1, 0.01, 0.001 in 16, 5, 1. The least was 3e-3, but for one of
  /// three bodies whose search had not come to rest (4e-17). What it lacks, -lg p of each: missing body 15 31, Dahl's friction
  /// 14 19, clocks that run apart 10 10, mode in the band 3.3 9.0, backlash 4.9 0.1, link friction 3.1 1.4, a spring that stiffens
  /// 0.8 3.1; those below 4 have an interval that is too wide, or holds the truth.
  static constexpr double least_p = 1e-4;
  /// Of the upper end of the critical stiffness's interval to the lower: above, the interval is too wide.
  static constexpr double widest_interval = 1.5;
  /// Of the interval, by logarithms: a search that was stopped after a step which moved the limit by more has not come to its end. An
  /// end of the interval that was stopped lies as far out again; at 0.05, 2 of 8 right records were doubted for such a step.
  static constexpr double most_change = 0.5;
  /// Lags of the force whose correlation with the residuals is tested, samples: forces that came before. Those of the same sample
  /// and later hang on the position's noise where a controller makes them (Ljung 1999, 13.4). Dense where a response begins, a
  /// factor of about 1.4 apart later: neighbours there tell the same of a smooth force.
  static constexpr std::array<int, 12> force_lags = {1, 2, 3, 5, 7, 10, 14, 20, 30, 45, 70, 100};
  /// Rounding is noise where the record moves by so many encoder steps within so many samples.
  static constexpr double least_steps = 3.5;
  static constexpr Eigen::Index moving_within = 64;
  /// By what the halves of an interval are multiplied: rounding of an encoder is no noise where the motion turns, and looks like
  /// friction there. Two small looks at simulated records stand behind it, no campaign of its own. Of 60 of all kinds 7 % were off
  /// by more than 1.96 deviations. Of 28 short ones made as the documents say 18 % were, and at most one by more than 2.7, which
  /// is 1.4 times that; most were too low, on the safe side.
  static constexpr double more_than_noise = 1.4;
  /// Parts of a segment, and of its spectrum, whose shares in the limit are taken as independent. Of the same 89 records the
  /// widening was 1 in half, below 1.6 in nine of ten, at most 3.6.
  static constexpr int parts_of_limit = 16;
  /// Where phase and slope of a response agree this little or less, its sign is turned. 130 records of the identification campaign
  /// (all kinds, seeds 1 and 2) have 0.41 to 1, 128 of them more than 0.66; turned, the same with a minus.
  static constexpr double turned_agreement = -0.3;
  /// A direction that the fitted ones explain up to this share of its size says nothing of its own.
  static constexpr double least_share = 1e-3;
};

}  // namespace zwidth::internal
