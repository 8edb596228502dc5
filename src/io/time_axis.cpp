#include "io/time_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/column_unit.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {
namespace {

constexpr unsigned most_timer_bits = 52;        // whole numbers that a double holds exactly
constexpr double slowest_likely_period = 0.1;   // s
constexpr double fastest_likely_period = 1e-7;  // s

using Refusal = tl::unexpected<InputError>;

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
    return Refusal(InputError{{.file = times.source, .key = "timer bits"},
                              {.code = ProblemCode::count_out_of_range,
                               .evidence = {counted("value", bits), counted("least", 1),
                                            counted("most", most_timer_bits), counted("several", bits)}}});
  }
  const double turn = std::ldexp(1.0, static_cast<int>(bits));
  double turns = 0.0;
  double last = -1.0;
  for (std::size_t i = 0; i < times.values.size(); ++i) {
    double& time = times.values[i];
    if (!std::isfinite(time)) continue;
    if (time < 0.0 || time >= turn || time != std::floor(time)) {
      return Refusal(refused_sample(times, i,
                                    {.code = ProblemCode::no_timer_count,
                                     .evidence = {{"value", time}, counted("bits", bits), {"most", turn - 1.0}}}));
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
          times, i, {.code = ProblemCode::times_not_rising, .evidence = {{"time", t[i]}, counted("times", still)}}));
    }
    const double period = std::max(i >= 2 ? t[i - 1] - t[i - 2] : 0.0, i + 1 < t.size() ? t[i + 1] - t[i] : 0.0);
    const unsigned bits = bits_of_wrap(t[i - 1], t[i], period);
    Problem problem{.code = ProblemCode::times_not_rising, .evidence = {{"time", t[i - 1]}, {"after", t[i]}}};
    if (bits > 0) problem.evidence.push_back(counted("bits", bits));
    return Refusal(refused_sample(times, i, std::move(problem)));
  }
  return {};
}

Remark lost_rows_remark(const TimeAxis& axis, const RestoredRows& rows) {
  const std::size_t all = axis.grid.slots.back() + 1;
  const std::vector<double>& times = axis.column.values;
  Finding found{.code = FindingCode::rows_lost,
                .evidence = {counted("lost", rows.lost),
                             counted("rows", all),
                             {"share", static_cast<double>(rows.lost) / static_cast<double>(all)},
                             counted("gaps", rows.gaps),
                             counted("longest", rows.longest_gap),
                             {"after", times[rows.first_gap] - times[0]}},
                .subjects = {{"place", place_of(axis.column, rows.first_gap + 1)}}};
  if (rows.filled > 0) {
    found.evidence.push_back(counted("filled", rows.filled));
    found.evidence.push_back({"error", rows.filling_error});
  }
  if (rows.used_rows < times.size()) {
    found.evidence.push_back({"used", static_cast<double>(rows.used_rows - 1) * rows.period});
    found.subjects.push_back({"from", place_of(axis.column, rows.first_row)});
  }
  return warning(std::move(found));
}

/// Where it leaves the delay open, a doubt as well.
void add_jitter(const RestoredRows& rows, Recording& recording) {
  using enum RestoredRows::Jitter;
  Finding found{.code = FindingCode::jitter_undecided,
                .evidence = {{"largest", rows.largest_jitter}, {"rms", rows.jitter_rms}}};
  if (rows.jitter != unknown) {
    found.code = rows.jitter == of_rows ? FindingCode::jitter_of_rows : FindingCode::jitter_of_stamps;
    recording.remarks.push_back(note(std::move(found)));
    return;
  }
  found.evidence.push_back({"delay", rows.jitter_rms * rows.jitter_rms});
  recording.remarks.push_back(warning(found));
  constexpr double large = 0.1;  // periods, rms: then it matters by 1 % of a period's delay
  if (rows.jitter_rms <= large) return;
  found.evidence.push_back({"threshold", large});
  recording.doubts.push_back(std::move(found));
}

std::vector<Remark> axis_remarks(const RawColumn& times, double period, const RecordingOptions& options) {
  std::vector<Remark> remarks;
  const bool from_name = !options.time_scale && named_scale(times.name).has_value();
  const double scale = time_scale_of(times.name, options);
  remarks.push_back(note({.code = FindingCode::rate_of_times,
                          .evidence = {{"rate", 1.0 / period}, {from_name ? "scale_of_name" : "scale", scale}},
                          .subjects = {{"column", in_quotes(times.name)}}}));
  if (period > slowest_likely_period || period < fastest_likely_period) {
    const double threshold = period > slowest_likely_period ? slowest_likely_period : fastest_likely_period;
    remarks.push_back(
        warning({.code = FindingCode::period_unusual, .evidence = {{"period", period}, {"threshold", threshold}}}));
  }
  return remarks;
}

}  // namespace

tl::expected<TimeAxis, InputError> time_axis(RawColumn times, const RecordingOptions& options) {
  if (times.values.size() < 2) {
    return Refusal(
        InputError{{.file = times.source, .key = shortened(times.name)},
                   {.code = ProblemCode::too_few_samples, .evidence = {counted("samples", times.values.size())}}});
  }
  const double scale = time_scale_of(times.name, options);
  if (!std::isfinite(scale) || scale <= 0.0) {
    require_valid(not_above_zero("time_scale", scale, "s"));
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
    return Refusal(
        InputError{{.file = times.source, .key = shortened(times.name)}, {.code = ProblemCode::no_period_in_times}});
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

OptionProblem not_above_zero(std::string member, double value, const std::string& unit) {
  return option_problem(std::move(member), {.code = ProblemCode::not_finite_and_positive,
                                            .evidence = {{"value", value}},
                                            .subjects = {{"in", unit}, {"unit", unit}}});
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
    require_valid(not_above_zero("rate", rate, "Hz"));
  }
  return 1.0 / rate;
}

std::optional<Finding> contradiction(double rate, const TimeAxis& axis, const RecordingOptions& options) {
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
  return Finding{.code = FindingCode::rate_contradicts_times,
                 .evidence = {{"given", rate}, {"stated", stated}, {"threshold", most_difference}},
                 .subjects = {{"column", shortened(axis.column.name)}}};
}

void add_row_findings(const TimeAxis& axis, const RestoredRows& rows, Recording& recording) {
  if (rows.lost > 0) recording.remarks.push_back(lost_rows_remark(axis, rows));
  if (rows.jitter != RestoredRows::Jitter::none) add_jitter(rows, recording);
}

void add_contradiction(const Finding& finding, Recording& recording) {
  recording.remarks.push_back(warning(finding));
  recording.doubts.push_back(finding);
}

}  // namespace zwidth::internal
