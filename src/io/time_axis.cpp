#include "io/time_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/column_names.hpp"
#include "io/column_unit.hpp"
#include "io/prose.hpp"
#include "signal/median.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

constexpr unsigned most_timer_bits = 52;         // whole numbers that a double holds exactly
constexpr double shortest_gap = 1.5;             // median periods
constexpr double largest_jitter = 0.01;          // of the mean period
constexpr double slowest_likely_period = 0.1;    // s
constexpr double fastest_likely_period = 1e-7;   // s
constexpr std::size_t most_for_median = 100001;  // periods; all of them in shorter records

using Refusal = tl::unexpected<InputError>;

/// "12 ms": what fits the size of a time.
std::string in_seconds(double time) {
  const double size = std::abs(time);
  if (size > 0.0 && size < 1e-3) return fmt::format("{:.4g} us", time * 1e6);
  if (size > 0.0 && size < 1.0) return fmt::format("{:.4g} ms", time * 1e3);
  return fmt::format("{:.6g} s", time);
}

/// "t_ms" is t in ms; without such an ending, no unit.
NameAndUnit name_and_suffix(std::string_view name) {
  const std::size_t mark = name.find_last_of("_/");
  if (mark == std::string_view::npos || !seconds_per(name.substr(mark + 1))) return {name, {}};
  return {name.substr(0, mark), name.substr(mark + 1)};
}

/// Seconds per unit, where the column's name says it.
std::optional<double> named_scale(const std::string& column) {
  const auto [name, unit] = name_and_unit(column);
  if (const auto scale = seconds_per(unit)) return scale;
  const std::string lower = lower_case(name);
  if (const auto scale = seconds_per(name_and_suffix(lower).unit)) return scale;
  return lower.size() > 1 ? seconds_per(lower) : std::nullopt;
}

tl::expected<void, InputError> unwrap(RawColumn& times, unsigned bits) {
  if (bits < 1 || bits > most_timer_bits) {
    return Refusal(InputError{times.source, 0, 0, "timer bits", fmt::format("are {}", bits),
                              fmt::format("must be 1 to {}", most_timer_bits)});
  }
  const double turn = std::ldexp(1.0, static_cast<int>(bits));
  double turns = 0.0;
  double last = -1.0;
  for (std::size_t i = 0; i < times.values.size(); ++i) {
    double& time = times.values[i];
    if (!std::isfinite(time)) continue;
    if (time < 0.0 || time >= turn || time != std::floor(time)) {
      return Refusal(
          refused_sample(times, i, fmt::format("is {:.17g}", time),
                         fmt::format("a timer of {} bits shows whole numbers from 0 to {:.0f}", bits, turn - 1.0)));
    }
    if (time < last) turns += turn;
    last = time;
    time += turns;
  }
  return {};
}

/// Bits of the timer of which the fall from `before` to `after` is a wrap; 0 where it looks like none.
unsigned bits_of_wrap(double before, double after, double period) {
  for (const unsigned bits : {8U, 10U, 12U, 16U, 24U, 32U}) {
    const double turn = std::ldexp(1.0, static_cast<int>(bits));
    const double step = after + turn - before;
    const bool whole = before == std::floor(before) && after == std::floor(after);
    if (whole && before < turn && after >= 0.0 && step > 0.0 && step < 3.0 * period) return bits;
  }
  return 0;
}

/// Checked column of times in s, its periods seen as differences.
class Periods {
 public:
  explicit Periods(const std::vector<double>& times) : times_(times), median_(median()) {}

  [[nodiscard]] std::size_t size() const { return times_.size() - 1; }
  [[nodiscard]] double operator[](std::size_t i) const { return times_[i + 1] - times_[i]; }

  /// A long period that its neighbours do not make up: a sample that was only late is no gap.
  [[nodiscard]] bool is_gap(std::size_t i) const {
    if ((*this)[i] < shortest_gap * median_) return false;
    double excess = (*this)[i] - median_;
    if (i > 0) excess += (*this)[i - 1] - median_;
    if (i + 1 < size()) excess += (*this)[i + 1] - median_;
    return excess >= (shortest_gap - 1.0) * median_;
  }

  [[nodiscard]] double median() const {
    const std::size_t stride = (size() + most_for_median - 1) / most_for_median;
    std::vector<double> sample;
    for (std::size_t i = 0; i < size(); i += stride) sample.push_back((*this)[i]);
    return internal::median(std::move(sample));
  }

 private:
  const std::vector<double>& times_;
  double median_;
};

tl::expected<void, InputError> refuse_times_that_do_not_rise(const RawColumn& times) {
  const auto& t = times.values;
  const auto rises = [](double before, double after) { return after > before; };
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (rises(t[i - 1], t[i])) continue;
    if (t[i] == t[i - 1]) {
      std::size_t still = 0;
      for (std::size_t k = i; k < t.size(); ++k) {
        if (t[k] == t[k - 1]) ++still;
      }
      return Refusal(refused_sample(
          times, i, fmt::format("the time stands still at {:.12g}, {} times in the record", t[i], still),
          "times must rise: where they have too few digits or are repeated, state the rate instead (`rate`)"));
    }
    const double period = std::max(i >= 2 ? t[i - 1] - t[i - 2] : 0.0, i + 1 < t.size() ? t[i + 1] - t[i] : 0.0);
    const unsigned bits = bits_of_wrap(t[i - 1], t[i], period);
    return Refusal(refused_sample(times, i, fmt::format("the time falls from {:.12g} to {:.12g}", t[i - 1], t[i]),
                                  bits > 0 ? fmt::format("times must rise: this looks like a timer of {} bits that "
                                                         "wraps (`timer_bits` {})",
                                                         bits, bits)
                                           : "times must rise, or state the rate instead (`rate`)"));
  }
  return {};
}

/// Where the periods leave the uniform axis.
struct Irregularity {
  std::size_t gaps = 0;
  std::size_t first_gap = 0;    ///< index of a period
  double longest_gap = 0.0;     ///< s
  double time_in_gaps = 0.0;    ///< s
  double worst_period = 0.0;    ///< s; among those that are no gaps, the one farthest from the mean
  std::size_t worst_place = 0;  ///< its index
  double drift = 0.0;           ///< s; largest distance of two times' errors against the uniform axis between gaps
};

void find_gaps(const Periods& periods, Irregularity& found) {
  for (std::size_t i = 0; i < periods.size(); ++i) {
    if (!periods.is_gap(i)) continue;
    if (found.gaps++ == 0) found.first_gap = i;
    found.longest_gap = std::max(found.longest_gap, periods[i]);
    found.time_in_gaps += periods[i];
  }
}

void find_jitter(const Periods& periods, double mean, Irregularity& found) {
  double error = 0.0;
  double least = 0.0;
  double most = 0.0;
  found.worst_period = mean;
  for (std::size_t i = 0; i < periods.size(); ++i) {
    if (periods.is_gap(i)) {
      error = least = most = 0.0;
      continue;
    }
    if (std::abs(periods[i] - mean) > std::abs(found.worst_period - mean)) {
      found.worst_period = periods[i];
      found.worst_place = i;
    }
    error += periods[i] - mean;
    least = std::min(least, error);
    most = std::max(most, error);
    found.drift = std::max(found.drift, most - least);
  }
}

Remark gap_remark(const RawColumn& times, const Irregularity& found, double period) {
  const double lost = std::round(found.time_in_gaps / period) - static_cast<double>(found.gaps);
  return {
      Remark::Severity::warning,
      fmt::format("{} in the time axis, the first before {} ({} after the start), the longest {}: about {:.0f} "
                  "samples are lost",
                  found.gaps == 1 ? "a gap" : fmt::format("{} gaps", found.gaps), place_of(times, found.first_gap + 1),
                  in_seconds(times.values[found.first_gap] - times.values[0]), in_seconds(found.longest_gap), lost),
      "the samples are used as if nothing were lost: each gap shifts what follows and smears the response; "
      "better cut the record there"};
}

Remark jitter_remark(const RawColumn& times, const Irregularity& found, double period) {
  constexpr double share_of_rate = 0.1;
  const double degrees = 360.0 * share_of_rate * found.drift / period;
  return {Remark::Severity::warning,
          fmt::format("the sampling period varies by up to {:.3g} % of its mean ({} before {}); the times stay within "
                      "{} of a uniform axis",
                      100.0 * std::abs(found.worst_period - period) / period, in_seconds(found.worst_period),
                      place_of(times, found.worst_place + 1), in_seconds(found.drift)),
          fmt::format("the samples are used as if equally spaced: at a tenth of the rate, {:.4g} Hz, the phase may err "
                      "by {:.2g} degrees",
                      share_of_rate / period, degrees)};
}

std::vector<Remark> axis_remarks(const RawColumn& times, const Irregularity& found, double period,
                                 const RecordingOptions& options) {
  std::vector<Remark> remarks;
  const bool from_name = !options.time_scale && named_scale(times.name).has_value();
  const double scale = time_scale_of(times.name, options);
  remarks.push_back({Remark::Severity::note,
                     fmt::format("rate {:.7g} Hz: the mean of the times in column {}, read in units of {:.6g} s{}",
                                 1.0 / period, in_quotes(times.name), scale, from_name ? " as its name says" : ""),
                     ""});
  if (period > slowest_likely_period || period < fastest_likely_period) {
    remarks.push_back({Remark::Severity::warning, fmt::format("a sampling period of {} is unusual", in_seconds(period)),
                       "if the times are not in the unit above, state the unit (`time_scale`; milliseconds: 1e-3)"});
  }
  if (found.gaps > 0) remarks.push_back(gap_remark(times, found, period));
  if (std::abs(found.worst_period - period) > largest_jitter * period) {
    remarks.push_back(jitter_remark(times, found, period));
  }
  return remarks;
}

}  // namespace

tl::expected<TimeAxis, InputError> time_axis(RawColumn times, const RecordingOptions& options) {
  if (times.values.size() < 2) {
    return Refusal(InputError{times.source, 0, 0, shortened(times.name),
                              fmt::format("has {} sample{}", times.values.size(), times.values.size() == 1 ? "" : "s"),
                              "a time axis needs two at least"});
  }
  const double scale = time_scale_of(times.name, options);
  if (!std::isfinite(scale) || scale <= 0.0) {
    throw Error(ErrorCode::invalid_argument, fmt::format("time_scale is {}; it must be positive", scale));
  }
  TimeAxis axis;
  if (options.timer_bits) {
    if (auto unwrapped = unwrap(times, *options.timer_bits); !unwrapped) return Refusal(std::move(unwrapped.error()));
  }
  if (auto filled = fill_missing(times, axis.remarks); !filled) return Refusal(std::move(filled.error()));
  if (auto rising = refuse_times_that_do_not_rise(times); !rising) return Refusal(std::move(rising.error()));
  for (double& time : times.values) time *= scale;

  const double span = times.values.back() - times.values.front();
  const auto no_period = [&] {
    return Refusal(InputError{times.source, 0, 0, shortened(times.name),
                              "the times are too large or too small for a sampling period", "must be times in s"});
  };
  if (!std::isfinite(span)) return no_period();
  const Periods periods(times.values);
  Irregularity found;
  find_gaps(periods, found);
  axis.sampling_period = (span - found.time_in_gaps) / static_cast<double>(periods.size() - found.gaps);
  if (!std::isfinite(1.0 / axis.sampling_period) || axis.sampling_period <= 0.0) return no_period();
  find_jitter(periods, axis.sampling_period, found);
  const auto remarks = axis_remarks(times, found, axis.sampling_period, options);
  axis.remarks.insert(axis.remarks.begin(), remarks.begin(), remarks.end());
  return axis;
}

double time_scale_of(const std::string& column, const RecordingOptions& options) {
  return options.time_scale ? *options.time_scale : named_scale(column).value_or(1.0);
}

bool names_a_time(const std::string& column) {
  constexpr std::array<std::string_view, 8> words{"t",          "time",         "times", "timestamp",
                                                  "time stamp", "elapsed time", "zeit",  "temps"};
  const std::string name = lower_case(name_and_unit(column).name);
  const std::string_view plain = name_and_suffix(name).name;
  const bool is_unit_of_time = name.size() > 2 && name != "min" && seconds_per(name).has_value();
  return is_unit_of_time || std::find(words.begin(), words.end(), plain) != words.end();
}

TimeAxis axis_of_rate(double rate) {
  if (!std::isfinite(rate) || rate <= 0.0 || !std::isfinite(1.0 / rate)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("rate is {} Hz; it must be positive", rate));
  }
  return {1.0 / rate, {}};
}

std::optional<Remark> contradiction(double rate, const UnusedTimes& times, const RecordingOptions& options) {
  constexpr double most_difference = 0.01;
  const bool is_unit_known = options.time_scale || named_scale(times.column);
  const double span = (times.last - times.first) * time_scale_of(times.column, options);
  if (times.samples < 2 || !std::isfinite(span) || span <= 0.0) return std::nullopt;
  const double stated = static_cast<double>(times.samples - 1) / span;
  // Times without a unit in their name may be in ms, us or ns.
  const std::vector<double> units = is_unit_known ? std::vector{1.0} : std::vector{1.0, 1e3, 1e6, 1e9};
  const bool agrees = std::any_of(units.begin(), units.end(), [&](double per_second) {
    return std::abs(rate - stated * per_second) <= most_difference * rate;
  });
  if (agrees) return std::nullopt;
  return Remark{Remark::Severity::warning,
                fmt::format("the rate is given as {:.7g} Hz; the times in column {} say {:.7g} Hz", rate,
                            shortened(times.column), stated),
                "the given rate is used; leave it out to use the times, or give their scale"};
}

void add_contradiction(const Remark& remark, Recording& recording) {
  recording.remarks.push_back(remark);
  recording.doubts.push_back(fmt::format("{}; {}", remark.what, remark.consequence));
}

}  // namespace zwidth::internal
