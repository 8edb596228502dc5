#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace zwidth {

/// What swings near a predicted frequency.
struct WatchedSwing {
  double frequency = 0.0;    ///< rad/s; 0: nothing is watched
  double amplitude = 0.0;    ///< m or rad, in the last whole window; 0: none is whole yet
  double growth_rate = 0.0;  ///< 1/s, from the window before to that one; 0 where there is no window before
};

/// Notices an oscillation that grows while it runs: the power near the predicted frequencies, window by window.
///
///     A_j = 2 |sum_n h[n] (x[n] - mean x) e^{-jwnT}| / sum_n h[n]
///
/// with Hann windows h of six cycles of each w, one after the other.
///
/// Detected where A has risen over four windows in a row, by half in all, lies above the floor, and is what moves the
/// device: at least a tenth of all that varies in the window, by amplitude.
/// An oscillation elsewhere is noticed by all that varies: it has to cross its mean eight times or more in each window
/// of the lowest frequency, and to rise in the same way.
/// After construction nothing allocates, locks, logs or throws.
class OscillationWatch {
 public:
  static constexpr std::size_t most_frequencies = 8;  ///< that are watched

  /// Frequencies in rad/s, those in (0, 0.98 pi/T) and at most the first eight of them; `floor` in m or rad, >= 0.
  /// Throws Error (invalid_argument) for a period that is not > 0 and a floor that is not a number >= 0.
  OscillationWatch(std::span<const double> frequencies, double sampling_period, double floor);

  /// Whether an oscillation has been seen to grow, this sample included.
  bool update(double position) noexcept;
  [[nodiscard]] bool detected() const noexcept { return detected_; }  ///< an oscillation grew, now or before
  /// rad/s, of the band that grew; 0: none did.
  [[nodiscard]] double frequency() const noexcept { return frequency_; }
  /// What swings most, of the predicted frequencies.
  [[nodiscard]] WatchedSwing strongest() const noexcept;

 private:
  /// A rise, window by window.
  struct Rise {
    double last = 0.0;
    double before = 0.0;
    double lowest = 0.0;  // where it began
    int windows = 0;
    /// The next window's amplitude; whether it has risen long and far enough.
    bool update(double amplitude) noexcept;
  };

  struct Band {
    double frequency = 0.0;
    std::size_t length = 0;  // of a window
    std::complex<double> turn{1.0, 0.0};
    std::complex<double> window_turn{1.0, 0.0};
    double scale = 0.0;
    std::complex<double> leakage{};  // sum of a window of ones
    std::size_t sample = 0;
    std::complex<double> carrier{1.0, 0.0};
    std::complex<double> hann{1.0, 0.0};
    std::complex<double> sum{};
    double position_sum = 0.0;
    double square_sum = 0.0;
    Rise rise = {};
  };

  /// Windows of all that varies.
  struct Sweep {
    std::size_t length = 0;
    std::size_t sample = 0;
    double mean = 0.0;  // of the window before
    bool is_above = false;
    int crossings = 0;
    double position_sum = 0.0;
    double square_sum = 0.0;
  };

  bool advance(Band& band, double position) const noexcept;
  bool sweep(double position) noexcept;

  std::array<Band, most_frequencies> bands_{};
  std::size_t count_ = 0;
  Sweep sweep_;
  Rise sweep_rise_;
  double period_ = 0.0;
  double floor_ = 0.0;
  bool started_ = false;
  double origin_ = 0.0;
  bool detected_ = false;
  double frequency_ = 0.0;
};

}  // namespace zwidth
