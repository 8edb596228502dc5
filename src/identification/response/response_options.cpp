#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "band_problem.hpp"
#include "counted.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth {
namespace {

using internal::counted;

}  // namespace

std::optional<OptionProblem> find_problem(const FrequencyResponseOptions& options) {
  using Excitation = FrequencyResponseOptions::Excitation;
  const Excitation excitation = excitation_of(options);
  if (!(options.overlap >= 0.0 && options.overlap < 1.0)) {
    return option_problem("overlap",
                          {.code = ProblemCode::no_share_below_one, .evidence = {{"value", options.overlap}}});
  }
  if (options.segment_length && *options.segment_length < 2) {
    return option_problem("segment_length", {.code = ProblemCode::too_few,
                                             .evidence = {counted("value", *options.segment_length), {"least", 2.0}}});
  }
  if (options.segment_length && excitation == Excitation::periodic && options.lines.empty()) {
    return option_problem("segment_length", {.code = ProblemCode::segments_of_periodic_force});
  }
  if (options.period && *options.period < 2) {
    return option_problem(
        "period", {.code = ProblemCode::too_few, .evidence = {counted("value", *options.period), {"least", 2.0}}});
  }
  if (options.skip_periods > 0 && excitation == Excitation::aperiodic) {
    return option_problem("skip_periods", {.code = ProblemCode::periods_of_aperiodic_force,
                                           .evidence = {counted("value", options.skip_periods)}});
  }
  const auto wrong =
      std::ranges::find_if_not(options.lines, [](double line) { return std::isfinite(line) && line > 0.0; });
  if (wrong != options.lines.end())
    return option_problem("lines", {.code = ProblemCode::frequency_out_of_range,
                                    .evidence = {{"hertz", hertz(*wrong)}},
                                    .subjects = {{"entry", "line"}}});
  if (!options.lines.empty() && (options.segment_length || options.period)) {
    return option_problem("lines", {.code = ProblemCode::lines_beside_segments});
  }
  return internal::find_band_problem(options.lowest, options.highest);
}

}  // namespace zwidth
