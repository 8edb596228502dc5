#include "io/raw_column.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "counted.hpp"
#include "io/prose.hpp"

namespace zwidth::internal {
namespace {

/// More than this share of a column is not filled.
constexpr double largest_share_missing = 0.01;

bool is_missing(double value) { return !std::isfinite(value); }

/// Fills the missing values from `first` up to the present value at `next` (the size: there is none).
void fill_run(std::vector<double>& values, std::size_t first, std::size_t next) {
  if (first == 0 || next == values.size()) {
    const double nearest = first == 0 ? values[next] : values[first - 1];
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(next),
              nearest);
    return;
  }
  for (std::size_t i = first; i < next; ++i) {
    const double along = static_cast<double>(i - first + 1) / static_cast<double>(next - first + 1);
    values[i] = std::lerp(values[first - 1], values[next], along);
  }
}

}  // namespace

InputError refused_sample(const RawColumn& column, std::size_t sample, Problem problem) {
  InputPlace place{.file = column.source, .key = shortened(column.name)};
  if (column.line) {
    place.line = column.line(sample);
    place.column = 1;
  } else {
    problem.evidence.push_back(counted("sample", sample + 1));
  }
  return {std::move(place), std::move(problem)};
}

std::string place_of(const RawColumn& column, std::size_t sample) {
  return column.line ? fmt::format("line {}", column.line(sample)) : fmt::format("sample {}", sample + 1);
}

tl::expected<void, InputError> fill_missing(RawColumn& column, std::vector<Remark>& remarks) {
  auto& values = column.values;
  const auto first = std::find_if(values.begin(), values.end(), is_missing);
  if (first == values.end()) return {};
  const auto first_place = static_cast<std::size_t>(first - values.begin());
  const auto missing = static_cast<std::size_t>(std::count_if(first, values.end(), is_missing));
  const double share = static_cast<double>(missing) / static_cast<double>(values.size());
  if (share > largest_share_missing || missing == values.size()) {
    return tl::unexpected(
        refused_sample(column, first_place,
                       {.code = ProblemCode::too_many_samples_missing,
                        .evidence = {counted("missing", missing), counted("samples", values.size())}}));
  }
  std::size_t longest = 0;
  for (std::size_t i = first_place; i < values.size(); ++i) {
    if (!is_missing(values[i])) continue;
    std::size_t next = i;
    while (next < values.size() && is_missing(values[next])) ++next;
    fill_run(values, i, next);
    longest = std::max(longest, next - i);
    i = next;
  }
  remarks.push_back(warning(
      {.code = FindingCode::samples_missing,
       .evidence = {counted("missing", missing), counted("samples", values.size()), counted("longest", longest)},
       .subjects = {{"column", shortened(column.name)}, {"place", place_of(column, first_place)}}}));
  return {};
}

}  // namespace zwidth::internal
