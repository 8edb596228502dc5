#include "signal/restored_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "signal/band_interpolation.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t most_filled = 12;     // rows of a gap
constexpr double most_error = 0.01;         // rms of the force over the whole record that filling may make, relative
constexpr double least_jitter = 0.01;       // periods: less is no finding
constexpr std::size_t examined_gaps = 200;  // of each length
using Signals = std::span<const std::span<const double>>;

/// Mean square of a signal about its mean.
double power_of(std::span<const double> signal) {
  double mean = 0.0;
  for (const double each : signal) mean += each / static_cast<double>(signal.size());
  double power = 0.0;
  for (const double each : signal) power += (each - mean) * (each - mean) / static_cast<double>(signal.size());
  return power;
}

/// Mean square errors of each signal in rows that are there and taken for lost, `length` at a time, over its power.
std::vector<double> errors_of_filling(Signals signals, std::span<const double> places, std::size_t length,
                                      SignalBand band, std::span<const double> powers) {
  std::vector<double> errors(signals.size(), 0.0);
  const std::size_t rows = places.size();
  const std::size_t step = std::max<std::size_t>(length + 1, rows / examined_gaps);
  std::size_t count = 0;
  for (std::size_t first = 1; first + length < rows; first += step) {
    for (std::size_t i = first; i < first + length; ++i) {
      const RowWeights weights = weights_around(places, places[i], band, {first, first + length});
      for (std::size_t s = 0; s < signals.size(); ++s) {
        const double off = weights.of(signals[s]) - signals[s][i];
        errors[s] += off * off;
      }
      ++count;
    }
  }
  for (std::size_t s = 0; s < signals.size(); ++s) {
    errors[s] = count == 0 || powers[s] == 0.0 ? 0.0 : errors[s] / (static_cast<double>(count) * powers[s]);
  }
  return errors;
}

/// The band that tells rows best from those around them.
SignalBand best_band(Signals signals, std::span<const double> places, std::span<const double> powers) {
  SignalBand best;
  double least = std::numeric_limits<double>::infinity();
  for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {  // of half the rate
    for (const double noise : {1e-9, 1e-6, 1e-4}) {
      const SignalBand band{share * std::numbers::pi, noise};
      double sum = 0.0;
      for (const double error : errors_of_filling(signals, places, 1, band, powers)) sum += error;
      if (sum < least) std::tie(least, best) = std::pair(sum, band);
    }
  }
  return best;
}

/// What of a record can be used as one.
class Restoring {
 public:
  Restoring(std::span<const double> times, const RowGrid& grid, Signals signals)
      : times_(times), grid_(grid), signals_(signals.begin(), signals.end()) {
    for (const std::size_t slot : grid.slots) places_.push_back(static_cast<double>(slot));
    for (const auto& each : signals) powers_.push_back(power_of(each));
  }

  [[nodiscard]] RestoredRows result() {
    count_gaps();
    find_jitter();
    const bool matters = result_.lost > 0 || result_.largest_jitter > least_jitter;
    if (matters) band_ = best_band(signals_, places_, powers_);
    if (result_.lost > 0) cut();
    if (matters) find_jitter();
    if (result_.jitter != RestoredRows::Jitter::none) judge_jitter();
    fill();
    if (result_.jitter == RestoredRows::Jitter::of_rows) bring_to_equal_steps();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::size_t missing_after(std::size_t row) const { return grid_.slots[row + 1] - grid_.slots[row] - 1; }

  void count_gaps() {
    result_.used_rows = times_.size();
    result_.lost = grid_.lost();
    for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
      if (missing_after(i) == 0) continue;
      if (result_.gaps++ == 0) result_.first_gap = i;
      result_.longest_gap = std::max(result_.longest_gap, missing_after(i));
    }
  }

  /// In gaps of that length.
  [[nodiscard]] std::size_t rows_lost_by(std::size_t length) const {
    std::size_t rows = 0;
    for (std::size_t i = 0; i + 1 < times_.size(); ++i) rows += missing_after(i) == length ? length : 0;
    return rows;
  }

  /// Cuts at gaps that cannot be filled, and keeps the longest stretch.
  void cut() {
    std::size_t longest = 0;  // gap that is filled
    double squares = 0.0;
    for (std::size_t length = 1; length <= most_filled; ++length) {
      const std::size_t rows = rows_lost_by(length);
      if (rows > 0) {
        squares += static_cast<double>(rows) * errors_of_filling(signals_, places_, length, band_, powers_).front();
        const double error = std::sqrt(squares / static_cast<double>(times_.size()));
        if (!(error <= most_error)) break;
        result_.filling_error = error;
      }
      longest = length;
    }
    RowRange best;
    for (std::size_t first = 0; first < times_.size();) {
      std::size_t end = first + 1;
      while (end < times_.size() && missing_after(end - 1) <= longest) ++end;
      if (end - first > best.end - best.first) best = {first, end};
      first = end;
    }
    result_.first_row = best.first;
    result_.used_rows = best.end - best.first;
    if (result_.used_rows == times_.size()) return;
    const auto used = [&best](auto& all) { return all.subspan(best.first, best.end - best.first); };
    times_ = used(times_);
    for (auto& each : signals_) each = used(each);
    grid_ = row_grid(times_);
    places_.clear();
    for (const std::size_t slot : grid_.slots) places_.push_back(static_cast<double>(slot));
  }

  /// Of the times about the grid.
  void find_jitter() {
    double mean = 0.0;
    std::vector<double> off;
    for (std::size_t i = 0; i < times_.size(); ++i) {
      off.push_back((times_[i] - times_[0]) / grid_.period - places_[i]);
      mean += off.back() / static_cast<double>(times_.size());
    }
    result_.period = grid_.period;
    result_.start = times_[0] + mean * grid_.period;
    result_.largest_jitter = 0.0;
    double squares = 0.0;
    stamps_.clear();
    for (std::size_t i = 0; i < times_.size(); ++i) {
      result_.largest_jitter = std::max(result_.largest_jitter, std::abs(off[i] - mean));
      squares += (off[i] - mean) * (off[i] - mean);
      stamps_.push_back(places_[i] + off[i] - mean);
    }
    result_.jitter_rms = std::sqrt(squares / static_cast<double>(times_.size()));
    result_.jitter = result_.largest_jitter > least_jitter ? RestoredRows::Jitter::unknown : RestoredRows::Jitter::none;
  }

  /// The motion tells whether the rows or only their stamps are off the grid: it runs smoothly in the right times.
  void judge_jitter() {
    constexpr double clearly = 0.8;      // of the mean square error
    constexpr double most_wander = 0.5;  // periods, rms: the clock itself is another
    const std::span<const double> motion = signals_.back();
    const std::array only{motion};
    const std::array power{1.0};
    const double by_grid = errors_of_filling(only, places_, 1, band_, power).front();
    const double by_stamps = errors_of_filling(only, stamps_, 1, band_, power).front();
    if (by_grid < clearly * by_stamps) {
      result_.jitter = RestoredRows::Jitter::of_stamps;
    } else if (by_stamps < clearly * by_grid || result_.jitter_rms > most_wander) {
      result_.jitter = RestoredRows::Jitter::of_rows;
    }
  }

  /// All slots, by the rows around those that were lost.
  void fill() {
    for (const auto& each : signals_) {
      result_.signals.emplace_back();
      result_.signals.back().reserve(grid_.slots.back() + 1);
      result_.signals.back().push_back(each[0]);
    }
    held_from_ = {stamps_[0]};
    for (std::size_t i = 1; i < times_.size(); ++i) {
      const std::size_t missing = missing_after(i - 1);
      for (std::size_t k = 1; k <= missing; ++k) {
        const RowWeights weights = weights_around(places_, places_[i - 1] + static_cast<double>(k), band_);
        for (std::size_t s = 0; s < signals_.size(); ++s) result_.signals[s].push_back(weights.of(signals_[s]));
        held_from_.push_back(
            std::lerp(stamps_[i - 1], stamps_[i], static_cast<double>(k) / static_cast<double>(missing + 1)));
      }
      for (std::size_t s = 0; s < signals_.size(); ++s) result_.signals[s].push_back(signals_[s][i]);
      held_from_.push_back(stamps_[i]);
      result_.filled += missing;
    }
  }

  void bring_to_equal_steps() {
    for (std::size_t s = 0; s < signals_.size(); ++s) {
      std::vector<double>& signal = result_.signals[s];
      if (s == 0 && signals_.size() > 1) {
        signal = averaged_hold(held_from_, signal, 0.0, 1.0, signal.size());
        continue;
      }
      for (std::size_t k = 0; k < signal.size(); ++k) {
        signal[k] = weights_around(stamps_, static_cast<double>(k), band_).of(signals_[s]);
      }
    }
  }

  std::span<const double> times_;
  RowGrid grid_;
  std::vector<std::span<const double>> signals_;
  std::vector<double> places_;  ///< of the rows, in periods
  std::vector<double> stamps_;  ///< the same, by their times
  std::vector<double> powers_;
  std::vector<double> held_from_;  ///< of each slot, in periods
  SignalBand band_;
  RestoredRows result_;
};

}  // namespace

RestoredRows restored_rows(std::span<const double> times, const RowGrid& grid,
                           std::span<const std::span<const double>> signals) {
  return Restoring(times, grid, signals).result();
}

std::vector<double> averaged_hold(std::span<const double> times, std::span<const double> signal, double start,
                                  double period, std::size_t count) {
  std::vector<double> result(count, 0.0);
  std::size_t row = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double begin = start + static_cast<double>(k) * period;
    const double end = start + static_cast<double>(k + 1) * period;
    double sum = 0.0;
    double moment = 0.0;  // about the middle
    const auto add = [&](double value, double from, double to) {
      sum += value * (to - from);
      moment += value * (to - from) * (0.5 * (from + to) - 0.5 * (begin + end));
    };
    double from = begin;
    while (row + 1 < times.size() && times[row + 1] <= from) ++row;
    while (row + 1 < times.size() && times[row + 1] < end) {
      add(signal[row], from, std::max(times[row + 1], from));
      from = std::max(times[row + 1], from);
      ++row;
    }
    add(signal[row], from, end);
    result[k] += sum / period;
    if (k == 0 || k + 1 == count) continue;
    const double aside = moment / (2.0 * period * period);
    result[k - 1] -= aside;
    result[k + 1] += aside;
  }
  return result;
}

}  // namespace zwidth::internal
