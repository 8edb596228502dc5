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
#include "zwidth/error.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

constexpr unsigned most_timer_bits = 52;        // whole numbers that a double holds exactly
constexpr double slowest_likely_period = 0.1;   // s
constexpr double fastest_likely_period = 1e-7;  // s

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

Remark lost_rows_remark(const TimeAxis& axis, const RestoredRows& rows) {
  const std::size_t all = axis.grid.slots.back() + 1;
  const double share = static_cast<double>(rows.lost) / static_cast<double>(all);
  Remark remark{
      Remark::Severity::warning,
      fmt::format(
          "{} of {} rows are lost ({:.2g} %) in {}, the first before {} ({} after the start), the longest of {} "
          "row{}",
          rows.lost, all, 100.0 * share, rows.gaps == 1 ? "one gap" : fmt::format("{} gaps", rows.gaps),
          place_of(axis.column, rows.first_gap + 1),
          in_seconds(axis.column.values[rows.first_gap] - axis.column.values[0]), rows.longest_gap,
          rows.longest_gap == 1 ? "" : "s"),
      "", "log every row"};
  if (rows.filled > 0) {
    remark.consequence =
        fmt::format("{} are filled in from the rows around them, which tell the first signal to {:.2g} % of its size",
                    rows.filled, 100.0 * rows.filling_error);
  }
  if (rows.used_rows < axis.column.values.size()) {
    if (!remark.consequence.empty()) remark.consequence += "; ";
    remark.consequence += fmt::format(
        "what happened in {} gaps is not known: used is the longest stretch without such a gap alone, {} from {} on",
        rows.filled > 0 ? "the other" : "the", in_seconds(static_cast<double>(rows.used_rows - 1) * rows.period),
        place_of(axis.column, rows.first_row));
  }
  return remark;
}

Remark jitter_remark(const RestoredRows& rows) {
  using enum RestoredRows::Jitter;
  Remark remark{Remark::Severity::note,
                fmt::format("the times are up to {:.2g} % of a period off equal steps (rms {:.2g} %)",
                            100.0 * rows.largest_jitter, 100.0 * rows.jitter_rms),
                ""};
  switch (rows.jitter) {
    case of_rows:
      remark.consequence =
          "the rows were sampled so, as the motion shows: it is interpolated at equal steps, and the "
          "force that was held is averaged over each";
      break;
    case of_stamps:
      remark.consequence = "the rows were sampled at equal steps, as the motion shows: the stamps alone are off";
      break;
    default:
      remark.severity = Remark::Severity::warning;
      remark.consequence = fmt::format(
          "whether the rows or their stamps alone are off does not show in the motion: the delay is known "
          "to {:.2g} periods",
          rows.jitter_rms * rows.jitter_rms);
  }
  return remark;
}

std::vector<Remark> axis_remarks(const RawColumn& times, double period, const RecordingOptions& options) {
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
  if (!std::isfinite(span) || !(span > 0.0) || !std::isfinite(static_cast<double>(times.values.size()) / span)) {
    return no_period();
  }
  axis.grid = row_grid(times.values);
  axis.sampling_period = axis.grid.period;
  if (!std::isfinite(1.0 / axis.sampling_period) || axis.sampling_period <= 0.0) return no_period();
  const auto remarks = axis_remarks(times, axis.sampling_period, options);
  axis.remarks.insert(axis.remarks.begin(), remarks.begin(), remarks.end());
  axis.column = std::move(times);
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

double period_of_rate(double rate) {
  if (!std::isfinite(rate) || rate <= 0.0 || !std::isfinite(1.0 / rate)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("rate is {} Hz; it must be positive", rate));
  }
  return 1.0 / rate;
}

std::optional<Remark> contradiction(double rate, const TimeAxis& axis, const RecordingOptions& options) {
  constexpr double most_difference = 1e-3;  // a force is hardly known better
  const double rows = static_cast<double>(axis.column.values.size());
  const bool is_unit_known = options.time_scale || named_scale(axis.column.name);
  const double stated = 1.0 / axis.sampling_period;
  // Times without a unit in their name may be in ms, us or ns.
  const std::vector<double> units = is_unit_known ? std::vector{1.0} : std::vector{1.0, 1e3, 1e6, 1e9};
  const bool agrees = std::any_of(units.begin(), units.end(), [&](double per_second) {
    return std::abs(rate - stated * per_second) <= (most_difference + 1.0 / rows) * rate;
  });
  if (agrees) return std::nullopt;
  return Remark{Remark::Severity::warning,
                fmt::format("the rate is given as {:.7g} Hz; the times in column {} say {:.7g} Hz", rate,
                            shortened(axis.column.name), stated),
                "the given rate is used; leave it out to use the times, or give their scale"};
}

void add_row_findings(const TimeAxis& axis, const RestoredRows& rows, Recording& recording) {
  if (rows.lost > 0) recording.remarks.push_back(lost_rows_remark(axis, rows));
  if (rows.jitter == RestoredRows::Jitter::none) return;
  recording.remarks.push_back(jitter_remark(rows));
  constexpr double large = 0.1;  // periods, rms: then it matters by 1 % of a period's delay
  if (rows.jitter != RestoredRows::Jitter::unknown || rows.jitter_rms <= large) return;
  const Remark& remark = recording.remarks.back();
  recording.doubts.push_back(fmt::format("{}; {}; log the time at which a row is sampled, or state the rate",
                                         remark.what, remark.consequence));
}

void add_contradiction(const Remark& remark, Recording& recording) {
  recording.remarks.push_back(remark);
  recording.doubts.push_back(fmt::format("{}; {}", remark.what, remark.consequence));
}

}  // namespace zwidth::internal
