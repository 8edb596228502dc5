#include "identification/response/response_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "identification/response/line_response.hpp"
#include "identification/response/period_detection.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {

bool is_of_lines(std::span<const Recording> recordings, const FrequencyResponseOptions& options) {
  using Excitation = FrequencyResponseOptions::Excitation;
  if (!options.lines.empty() || options.excitation == Excitation::periodic) return true;
  return options.excitation == Excitation::detect && std::ranges::any_of(recordings, [](const Recording& each) {
           const std::vector<double>& force = each.channels[0].samples;
           return only_tone(force).has_value() || detect_period(force).has_value();
         });
}

double segment_duration(const FrequencyResponse& response) {
  double spacing = response.points.back().frequency;  // rad/s, of neighbouring lines
  for (std::size_t i = 1; i < response.points.size(); ++i) {
    spacing = std::min(spacing, response.points[i].frequency - response.points[i - 1].frequency);
  }
  return 2.0 * std::numbers::pi / spacing;
}

MeasuredResponse response_with_enough_lines(std::span<const Recording> recordings, const Device& structure,
                                            const IdentifyOptions& options, const Progress& progress) {
  MeasuredResponse measured = frequency_response(recordings, options.response, progress);
  const bool may_choose =
      recordings.size() == 1 && !options.response.segment_length && !is_of_lines(recordings, options.response);
  if (!may_choose || measured.response.points.size() < 2 || !measured.response.sampling_period) return measured;
  const std::size_t free = fittable_parameters(structure, options.fit.locked).size() + 2;
  constexpr std::size_t lines_each = 6;
  constexpr double least_averages = 6.0;  // fewer hardly show the noise
  constexpr std::size_t least_segments = 4;
  FrequencyResponseOptions longer = options.response;
  longer.excitation = FrequencyResponseOptions::Excitation::aperiodic;
  const std::size_t samples = recordings.front().channels[0].samples.size();
  auto length =
      static_cast<std::size_t>(std::lround(segment_duration(measured.response) / *measured.response.sampling_period));
  while (measured.response.points.size() < lines_each * free && 2.0 * least_averages <= measured.response.averages) {
    length *= 2;
    if (length > samples / least_segments) break;
    longer.segment_length = length;
    measured = frequency_response(recordings, longer, {});
  }
  return measured;
}

void refuse_nothing_left(const Recording& recording, const FrequencyResponseOptions& options) {
  const std::size_t samples = recording.channels[0].samples.size();
  if (options.lowest || options.highest) {
    refuse_member(options.lowest ? "lowest" : "highest", {.code = ProblemCode::band_leaves_no_line});
  }
  if (options.period) {
    Problem problem{.code = ProblemCode::period_without_line, .evidence = {counted("value", *options.period)}};
    if (const auto detected = detect_period(recording.channels[0].samples))
      problem.evidence.push_back(counted("repeats", *detected));
    refuse_member("period", std::move(problem));
  }
  throw Error(ErrorCode::invalid_argument,
              {.code = ProblemCode::no_line_excited,
               .evidence = {counted("samples", samples),
                            {"duration", static_cast<double>(samples) * recording.sampling_period}}});
}

}  // namespace zwidth::internal
