#include "simulation/loop_judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "simulation/straight_line.hpp"
#include "zwidth/signal/dominant_oscillation.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t windows = 8;         // of the second half
constexpr std::size_t least_samples = 64;  // of a run
constexpr double rest_share = 1e-6;        // of the run's range: a swing below is rest
constexpr double still_share = 1e-3;       // of the run's range: a range of the last sixteenth below has arrived
constexpr double few_steps = 4.0;          // of the encoder: a motion within them is no drift
constexpr double decayed_share = 0.05;     // of the run's range: a range of the last quarter that has died out
constexpr double steady_change = 0.01;     // of the logarithm of the effective swing over the second half
constexpr double significance = 4.0;       // standard errors of a trend, beyond which it is one
constexpr double of_the_swing = 0.5;       // of the power, of a sine that is the swing
constexpr double apart = 0.3;            // lines of the spectrum, which tells the frequency of a sine to a tenth of one
constexpr double unsteady_change = 0.2;  // a scatter that could hide so much leaves the verdict open

double range_of(std::span<const double> y) {
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return *high - *low;
}

bool is_monotonic(std::span<const double> y) {
  return std::is_sorted(y.begin(), y.end()) || std::is_sorted(y.rbegin(), y.rend());
}

/// Half of peak to peak about the straight line that fits best.
double swing_of(std::span<const double> y) { return 0.5 * range_of(without_line(y)); }

/// Root of the mean square about the straight line: unlike the swing it does not depend on where in a fast oscillation
/// the samples lie.
double effective_swing(std::span<const double> y) {
  double squares = 0.0;
  for (const double residual : without_line(y)) squares += residual * residual;
  return std::sqrt(squares / static_cast<double>(y.size()));
}

/// Standard error of the slope of the line through equally spaced values.
double slope_error(std::span<const double> y) {
  const auto n = static_cast<double>(y.size());
  double squares = 0.0;
  for (const double residual : without_line(y)) squares += residual * residual;
  return std::sqrt(squares / (n - 2.0) * 12.0 / (n * (n * n - 1.0)));
}

/// Where the position stops falling and begins to rise, about a straight line: indices into y, fractions by the
/// velocity's crossing of its mean. A steady drift has none, a curve one at most, each cycle of an oscillation one.
std::vector<double> lowest_points(std::span<const double> y) {
  const double mean = (y.back() - y.front()) / (static_cast<double>(y.size()) - 1.0);
  std::vector<double> points;
  double previous = 0.0;
  for (std::size_t i = 1; i < y.size(); ++i) {
    const double velocity = y[i] - y[i - 1] - mean;
    // The velocity over (i - 1, i) belongs to its middle.
    if (i > 1 && velocity > 0.0 && previous <= 0.0) {
      points.push_back(static_cast<double>(i) - 0.5 - velocity / (velocity - previous));
    }
    previous = velocity;
  }
  return points;
}

/// Where there are too few cycles for a trend: a motion whose range at least halves from quarter to quarter dies out,
/// one whose range grows threefold grows (twofold could be a steady push).
LoopVerdict judge_quarters(std::span<const double> y, double range) {
  const std::size_t quarter = y.size() / 4;
  const double second = range_of(y.subspan(quarter, quarter));
  const double third = range_of(y.subspan(2 * quarter, quarter));
  const double fourth = range_of(y.last(quarter));
  if (second > 0.0 && fourth >= 3.0 * third && third >= 3.0 * second) return LoopVerdict::unstable;
  if (fourth <= 0.5 * third && third <= 0.5 * second && fourth <= decayed_share * range) return LoopVerdict::settles;
  return LoopVerdict::undecided;
}

}  // namespace

LoopJudgement judge_loop(std::span<const double> position, double sampling_period, double resolution) {
  LoopJudgement judgement;
  if (position.size() < least_samples) return judgement;
  const double range = range_of(position);
  const double rest_swing = std::max(resolution, rest_share * range);
  const auto second_half = position.last(position.size() / 2);
  const auto end = second_half.last(second_half.size() / windows);
  const bool swings_at_end = swing_of(end) > rest_swing;
  const double still = std::max({2.0 * rest_swing, few_steps * resolution, still_share * range});
  const LoopVerdict quiet = range_of(end) <= still ? LoopVerdict::settles : LoopVerdict::drifts;

  const std::vector<double> points = lowest_points(second_half);
  const std::size_t cycles = points.empty() ? 0 : points.size() - 1;
  if (cycles < windows) {
    const LoopVerdict by_quarters = judge_quarters(position, range);
    if (by_quarters != LoopVerdict::undecided) {
      judgement.verdict = by_quarters;
      return judgement;
    }
    if (quiet == LoopVerdict::settles || !swings_at_end || is_monotonic(second_half)) judgement.verdict = quiet;
    return judgement;
  }
  std::array<double, windows> swings{};  // logarithms
  const auto boundary = [&](std::size_t k) { return static_cast<std::size_t>(points[k * cycles / windows]); };
  const auto window = [&](std::size_t k) {
    return second_half.subspan(boundary(k), boundary(k + 1) - boundary(k) + 1);
  };
  for (std::size_t k = 0; k < windows; ++k) swings[k] = std::log(std::max(effective_swing(window(k)), 1e-300));
  const double last_swing = swing_of(window(windows - 1));
  // The swings stand at the middles of their windows, which are equally long but for an irregular motion.
  const double window_length = (points.back() - points.front()) / static_cast<double>(windows);
  const StraightLine trend = straight_line(swings);
  const double windows_in_half = static_cast<double>(second_half.size()) / window_length;
  const double change = trend.slope * windows_in_half;
  const double uncertainty = significance * slope_error(swings) * windows_in_half;
  if (!swings_at_end || last_swing <= rest_swing) {
    judgement.verdict = quiet;
  } else if (std::abs(change) > std::max(steady_change, uncertainty)) {
    judgement.verdict = change > 0.0 ? LoopVerdict::unstable : LoopVerdict::settles;
  } else if (uncertainty < unsteady_change) {
    judgement.verdict = LoopVerdict::limit_cycle;
  }
  if (last_swing > rest_share * range) {
    judgement.growth_rate = trend.slope / (window_length * sampling_period);
    // Samples show no oscillation above Nyquist's frequency, whatever the interpolation at the ends says.
    const double samples = std::max(2.0, (points.back() - points.front()) / static_cast<double>(cycles));
    double frequency = 2.0 * std::numbers::pi / (samples * sampling_period);
    // Ripples of a chattering force and of a faster mode have lowest points of their own.
    const auto swing = dominant_oscillation(position, sampling_period);
    if (swing && swing->share >= of_the_swing && std::abs(frequency - swing->frequency) > apart * swing->resolution) {
      frequency = swing->frequency;
    }
    judgement.oscillation = Oscillation{frequency, last_swing};
  }
  return judgement;
}

}  // namespace zwidth::internal
