#pragma once

namespace zwidth {

/// Velocity from sampled positions: the backward difference, low-passed where asked for.
///
///     v[k] = a v[k-1] + (1 - a) (x[k] - x[k-1])/T,    a = exp(-2 pi f_c T); a = 0 without the low-pass
///
/// x in m or rad, v in m/s or rad/s. The first call takes the device to be at rest: v = 0.
/// After construction nothing allocates, locks, logs or throws: one object serves simulation and real-time loop.
/// Source: eq. 17 of Díaz & Gil for the difference; the low-pass is Wall's.
class VelocityFilter {
 public:
  /// f_c in Hz, >= 0 (0: the difference alone); T in s, > 0.
  /// Throws Error (invalid_argument) for values outside these ranges.
  VelocityFilter(double cutoff_hz, double sampling_period);

  /// v[k] from this sample's position; NaN where the position is NaN, from then on.
  [[nodiscard]] double update(double position) noexcept {
    if (!started_) previous_ = position;
    started_ = true;
    velocity_ = pole_ * velocity_ + (1.0 - pole_) * rate_ * (position - previous_);
    previous_ = position;
    return velocity_;
  }

  /// Forgets the past: the next call is the first.
  void reset() noexcept {
    started_ = false;
    velocity_ = 0.0;
  }

 private:
  double rate_ = 0.0;  // 1/T
  double pole_ = 0.0;  // a
  bool started_ = false;
  double previous_ = 0.0;
  double velocity_ = 0.0;
};

}  // namespace zwidth
