#include "signal/row_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "signal/median.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t most_for_median = 100001;  // periods; all of them in shorter records
constexpr std::size_t pause = 10;                // slots: what follows may have another phase

double median_period(std::span<const double> times) {
  const std::size_t periods = times.size() - 1;
  const std::size_t stride = (periods + most_for_median - 1) / most_for_median;
  std::vector<double> sample;
  for (std::size_t i = 0; i < periods; i += stride) sample.push_back(times[i + 1] - times[i]);
  return median(std::move(sample));
}

/// How well the times so many rows apart are whole periods: the mean cosine of their phase.
double rhythm(std::span<const double> times, std::size_t apart, double period) {
  constexpr std::size_t most = 2000;
  const std::size_t stride = std::max<std::size_t>(1, times.size() / most);
  double sum = 0.0;
  for (std::size_t i = 0; i + apart < times.size(); i += stride) {
    sum += std::cos(2.0 * std::numbers::pi * (times[i + apart] - times[i]) / period);
  }
  return sum;
}

/// The period near the median one in whose rhythm rows follow each other: first neighbours, then rows further and further
/// apart. Where rows are lost and others jitter, the median is too long.
double period_of_rhythm(std::span<const double> times, double median) {
  double period = median;
  double reach = 0.2;
  for (std::size_t apart = 1; apart <= 64 && 2 * apart < times.size(); apart *= 4) {
    constexpr int steps = 40;
    double best = period;
    double most = -std::numeric_limits<double>::infinity();
    for (int k = -steps; k <= steps; ++k) {
      const double tried = period * (1.0 + reach * k / steps);
      const double found = rhythm(times, apart, tried);
      if (found > most) std::tie(most, best) = std::pair(found, tried);
    }
    period = best;
    reach /= 4.0;
  }
  return period;
}

/// Whether all rows but a share follow each other by whole periods as they are.
bool keeps_time(std::span<const double> times, double period, double most_exceptions) {
  constexpr double rounding = 0.02;
  std::size_t exceptions = 0;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double steps = (times[i + 1] - times[i]) / period;
    if (std::abs(steps - std::round(steps)) > rounding) ++exceptions;
  }
  return static_cast<double>(exceptions) <= most_exceptions * static_cast<double>(times.size());
}

/// Slots by a clock that follows the times slowly.
std::vector<std::size_t> slots_of(std::span<const double> times, double period) {
  constexpr std::size_t ahead = 8;  // rows: slots rise, so that later rows bound the next one's
  constexpr double follows = 0.1;
  std::vector<std::size_t> slots{0};
  slots.reserve(times.size());
  double clock = times[0];
  for (std::size_t i = 1; i < times.size(); ++i) {
    double steps = 1e300;
    for (std::size_t j = 0; j < ahead && i + j < times.size(); ++j) {
      steps = std::min(steps, std::round((times[i + j] - clock) / period) - static_cast<double>(j));
    }
    constexpr double most = 1e15;
    steps = std::clamp(steps, 1.0, most);
    slots.push_back(slots.back() + static_cast<std::size_t>(steps));
    clock += steps * period;
    const double late = times[i] - clock;
    clock += steps > static_cast<double>(pause) ? late : follows * std::clamp(late, -0.5 * period, 0.5 * period);
  }
  return slots;
}

/// Sums of a straight line, with a height of its own for each stretch between pauses.
class LineSums {
 public:
  void add(double slot, double time) {
    ++count_;
    const double from_mean = slot - slot_;
    slot_ += from_mean / count_;
    time_ += (time - time_) / count_;
    squares_ += from_mean * (slot - slot_);
    products_ += from_mean * (time - time_);
  }
  void end_stretch() { count_ = slot_ = time_ = 0.0; }
  [[nodiscard]] double slope() const { return products_ / squares_; }
  [[nodiscard]] bool has_slope() const { return squares_ > 0.0; }

 private:
  double count_ = 0.0;
  double slot_ = 0.0;
  double time_ = 0.0;
  double squares_ = 0.0;
  double products_ = 0.0;
};

}  // namespace

RowGrid row_grid(std::span<const double> times) {
  const double middle = median_period(times);
  constexpr double nearly_all = 0.02;
  const double typical = keeps_time(times, middle, nearly_all) ? middle : period_of_rhythm(times, middle);
  RowGrid grid{typical, slots_of(times, typical)};
  if (grid.lost() == 0 && keeps_time(times, typical, 0.0)) {
    grid.period = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    return grid;
  }
  std::vector<bool> is_far(times.size(), false);
  for (int round = 0; round < 2; ++round) {
    LineSums sums;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (i > 0 && grid.slots[i] - grid.slots[i - 1] > pause) sums.end_stretch();
      if (!is_far[i]) sums.add(static_cast<double>(grid.slots[i]), times[i] - times[0]);
    }
    if (!sums.has_slope()) break;
    grid.period = sums.slope();
    if (round > 0) break;
    // Against the median over a stretch: a clock that wanders is no outlier.
    constexpr std::size_t stretch = 1000;
    for (std::size_t first = 0; first < times.size(); first += stretch) {
      const std::size_t end = std::min(times.size(), first + stretch);
      std::vector<double> off;
      for (std::size_t i = first; i < end; ++i) {
        off.push_back(times[i] - times[first] - grid.period * static_cast<double>(grid.slots[i] - grid.slots[first]));
      }
      const double usual = median(off);
      std::vector<double> sizes;
      for (const double each : off) sizes.push_back(std::abs(each - usual));
      constexpr double far = 8.0;
      constexpr double rounding = 0.01;  // periods
      const double allowed = far * median(sizes) + rounding * typical;
      for (std::size_t i = first; i < end; ++i) is_far[i] = std::abs(off[i - first] - usual) > allowed;
    }
  }
  return grid;
}

}  // namespace zwidth::internal
