#include "io/response_lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "counted.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

using Refusal = tl::unexpected<InputError>;

constexpr double rounding = 1e-9;  // relative, of a frequency against half the sampling rate

bool is_number(const ResponseLine& line) {
  return std::isfinite(line.frequency) && std::isfinite(line.value.real()) && std::isfinite(line.value.imag()) &&
         std::isfinite(line.coherence);
}

/// Leaves out the lines of which `leave_out` is true; tells how many, and which was the first.
template <class Predicate>
std::pair<std::size_t, std::size_t> erase(std::vector<ResponseLine>& lines, Predicate leave_out) {
  const auto first = std::find_if(lines.begin(), lines.end(), leave_out);
  const std::size_t place = first == lines.end() ? 0 : first->line;
  return {std::erase_if(lines, leave_out), place};
}

/// The points of one frequency become one, their mean: of variance sum |H_i - H|^2 / (n (n - 1)) where there are n. A
/// point that comes once among repeated ones has their mean relative variance.
void pool_repeats(FrequencyResponse& response) {
  std::vector<ResponsePoint> pooled;
  double relative = 0.0;  // variances of one measurement, summed over the repeated frequencies
  std::vector<std::size_t> once;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  const std::vector<ResponsePoint>& points = response.points;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first;
    ResponsePoint mean{points[first].frequency, 0.0, 0.0, 0.0};
    while (end < points.size() && points[end].frequency == mean.frequency) ++end;
    const auto n = static_cast<double>(end - first);
    for (std::size_t i = first; i < end; ++i) {
      mean.value += points[i].value / n;
      mean.coherence += points[i].coherence / n;
    }
    if (end - first == 1) {
      mean = points[first];
      once.push_back(pooled.size());
    } else {
      for (std::size_t i = first; i < end; ++i) {
        mean.variance += std::norm(points[i].value - mean.value) / (n * (n - 1.0));
      }
      if (mean.value != 0.0) relative += n * mean.variance / std::norm(mean.value);
      fewest = std::min(fewest, end - first);
    }
    pooled.push_back(mean);
    first = end;
  }
  if (once.size() == pooled.size()) return;
  relative /= static_cast<double>(pooled.size() - once.size());
  for (const std::size_t i : once) pooled[i].variance = relative * std::norm(pooled[i].value);
  response.remarks.push_back(note({.code = FindingCode::repeated_lines_averaged,
                                   .evidence = {counted("lines", points.size()), counted("frequencies", pooled.size()),
                                                counted("once", once.size())}}));
  response.averages = static_cast<double>(fewest);
  response.points = std::move(pooled);
}

}  // namespace

tl::expected<FrequencyResponse, InputError> make_response(std::vector<ResponseLine> lines,
                                                          const ResponseTableOptions& options,
                                                          const std::string& source) {
  FrequencyResponse response;
  response.sampling_period = options.sampling_period;
  const auto refused = [&](const ResponseLine& line, std::string key, Problem problem) {
    return Refusal(InputError{
        {.file = source, .line = line.line, .column = line.line > 0 ? std::size_t{1} : 0, .key = std::move(key)},
        std::move(problem)});
  };
  const std::size_t all = lines.size();
  const auto [missing, first_missing] = erase(lines, [](const ResponseLine& line) { return !is_number(line); });
  if (missing > 0) {
    response.remarks.push_back(
        warning({.code = FindingCode::lines_without_number,
                 .evidence = {counted("missing", missing), counted("lines", all), counted("line", first_missing)}}));
  }
  const auto [zeros, first_zero] = erase(lines, [](const ResponseLine& line) { return line.frequency == 0.0; });
  if (zeros > 0) {
    response.remarks.push_back(
        note({.code = FindingCode::zero_frequency_left_out, .evidence = {counted("line", first_zero)}}));
  }
  const double highest =
      options.sampling_period ? std::numbers::pi / *options.sampling_period : std::numeric_limits<double>::infinity();
  for (ResponseLine& line : lines) {
    if (line.frequency > highest && line.frequency <= highest * (1.0 + rounding)) line.frequency = highest;
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const ResponseLine& a, const ResponseLine& b) { return a.frequency < b.frequency; });
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ResponseLine& line = lines[i];
    if (line.frequency < 0.0) {
      return refused(line, "frequency",
                     {.code = ProblemCode::frequency_out_of_range, .evidence = {{"hertz", hertz(line.frequency)}}});
    }
    if (line.frequency > highest) {
      return refused(line, "frequency",
                     {.code = ProblemCode::frequency_out_of_range,
                      .evidence = {{"hertz", hertz(line.frequency)}, {"nyquist", hertz(highest)}}});
    }
    if (i > 0 && line.frequency == lines[i - 1].frequency && line.value == lines[i - 1].value) {
      Problem problem{.code = ProblemCode::response_line_twice, .evidence = {{"hertz", hertz(line.frequency)}}};
      if (line.line > 0) problem.evidence.push_back(counted("line", lines[i - 1].line));
      return refused(line, "frequency", std::move(problem));
    }
    if (line.coherence < 0.0 || line.coherence > 1.0) {
      return refused(line, "coherence", {.code = ProblemCode::no_share, .evidence = {{"value", line.coherence}}});
    }
    const std::complex<double> value = line.value * options.scale;
    if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) {
      return refused(line, "", {.code = ProblemCode::sample_too_large, .evidence = {{"scale", options.scale}}});
    }
    response.points.push_back({line.frequency, value, 0.0, line.coherence});
  }
  pool_repeats(response);
  if (response.points.size() < 2) {
    return Refusal(InputError{{.file = source},
                              {.code = ProblemCode::too_few_samples,
                               .evidence = {counted("samples", response.points.size()), counted("lines", all)}}});
  }
  return response;
}

}  // namespace zwidth::internal
