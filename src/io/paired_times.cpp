#include "io/paired_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "counted.hpp"
#include "io/prose.hpp"
#include "io/time_axis.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

/// Of a period: stamps that differ by less are one, written with different digits.
constexpr double one_stamp = 1e-3;

/// The stamps of a column in s.
class Stamps {
 public:
  Stamps(const RawColumn& times, const RecordingOptions& options)
      : times_(times.values), scale_(time_scale_of(times.name, options)) {}

  [[nodiscard]] std::size_t size() const { return times_.size(); }
  [[nodiscard]] double operator[](std::size_t i) const { return scale_ * times_[i]; }
  [[nodiscard]] double first() const { return (*this)[0]; }
  [[nodiscard]] double last() const { return (*this)[size() - 1]; }
  [[nodiscard]] double mean_period() const { return (last() - first()) / static_cast<double>(size() - 1); }

  /// Index of the first stamp that is not before `time`.
  [[nodiscard]] std::size_t begin_at(double time) const {
    std::size_t i = 0;
    while (i < size() && (*this)[i] < time) ++i;
    return i;
  }
  /// Index after the last stamp that is not behind `time`.
  [[nodiscard]] std::size_t end_at(double time) const {
    std::size_t i = size();
    while (i > 0 && (*this)[i - 1] > time) --i;
    return i;
  }

 private:
  const std::vector<double>& times_;
  double scale_;
};

struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

void cut(RawColumn& column, const Span& span) {
  auto& values = column.values;
  values.erase(values.begin() + static_cast<std::ptrdiff_t>(span.end), values.end());
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(span.begin));
  if (span.begin == 0 || !column.line) return;
  column.line = [whole = std::move(column.line), first = span.begin](std::size_t sample) {
    return whole(first + sample);
  };
}

InputError other_times(const TimedColumn& column, const TimedColumn& first, const Stamps& own, const Stamps& others,
                       std::optional<std::size_t> sample) {
  Problem problem{.code = ProblemCode::columns_of_other_times,
                  .evidence = {counted("samples", own.size()),
                               {"first", own.first()},
                               {"last", own.last()},
                               {"rate", 1.0 / own.mean_period()},
                               counted("other_samples", others.size()),
                               {"other_first", others.first()},
                               {"other_last", others.last()},
                               {"other_rate", 1.0 / others.mean_period()}},
                  .subjects = {{"other", in_quotes(first.values.name)}}};
  if (sample) return refused_sample(column.values, *sample, std::move(problem));
  return {{.file = column.values.source, .key = shortened(column.values.name)}, std::move(problem)};
}

}  // namespace

tl::expected<std::vector<Remark>, InputError> keep_common_rows(std::vector<TimedColumn>& columns,
                                                               const RecordingOptions& options) {
  std::vector<Stamps> stamps;
  for (const TimedColumn& column : columns) {
    if (column.times.values.size() < 2) {
      return tl::unexpected(InputError{
          {.file = column.values.source, .key = shortened(column.values.name)},
          {.code = ProblemCode::too_few_samples, .evidence = {counted("samples", column.times.values.size())}}});
    }
    stamps.emplace_back(column.times, options);
  }
  const double period = stamps.front().mean_period();
  const double tolerance = std::isfinite(period) && period > 0.0 ? one_stamp * period : 0.0;
  double begin = stamps.front().first();
  double end = stamps.front().last();
  for (const Stamps& each : stamps) {
    begin = std::max(begin, each.first());
    end = std::min(end, each.last());
  }
  std::vector<Span> spans;
  for (const Stamps& each : stamps) spans.push_back({each.begin_at(begin - tolerance), each.end_at(end + tolerance)});
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto refused = [&](std::optional<std::size_t> sample) {
      const std::size_t other = k == 0 ? columns.size() - 1 : 0;
      return tl::unexpected(other_times(columns[k], columns[other], stamps[k], stamps[other], sample));
    };
    if (spans[k].end < spans[k].begin + 2) return refused(std::nullopt);
    const std::size_t size = spans[0].end - spans[0].begin;
    const std::size_t own_size = spans[k].end - spans[k].begin;
    for (std::size_t i = 0; i < std::min(size, own_size); ++i) {
      const double difference = stamps[k][spans[k].begin + i] - stamps[0][spans[0].begin + i];
      if (!(std::abs(difference) <= tolerance)) return refused(spans[k].begin + i);
    }
    if (own_size != size) return refused(std::nullopt);
  }

  std::vector<Remark> remarks;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::size_t all = stamps[k].size();
    const std::size_t kept = spans[k].end - spans[k].begin;
    if (kept == all) continue;
    remarks.push_back(
        note({.code = FindingCode::rows_outside_common_span,
              .evidence = {counted("used", kept), counted("samples", all), {"begin", begin}, {"end", end}},
              .subjects = {{"column", shortened(columns[k].values.name)}}}));
    cut(columns[k].values, spans[k]);
    cut(columns[k].times, spans[k]);
  }
  return remarks;
}

}  // namespace zwidth::internal
