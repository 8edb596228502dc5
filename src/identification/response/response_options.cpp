#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "zwidth/identification/measured_response.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth {
namespace {

std::optional<OptionProblem> find_band_problem(const FrequencyResponseOptions& options) {
  const auto wrong = [](const std::optional<double>& frequency) {
    return frequency && !(std::isfinite(*frequency) && *frequency > 0.0);
  };
  for (const auto& [member, value] : {std::pair{"lowest", options.lowest}, std::pair{"highest", options.highest}}) {
    if (wrong(value))
      return OptionProblem{member, fmt::format("is {:.6g} Hz", hertz(*value)), "must be finite and above 0"};
  }
  if (options.lowest && options.highest && *options.lowest >= *options.highest) {
    return OptionProblem{"highest", fmt::format("is {:.6g} Hz", hertz(*options.highest)),
                         fmt::format("must be above the lowest, {:.6g} Hz", hertz(*options.lowest))};
  }
  return std::nullopt;
}

}  // namespace

std::optional<OptionProblem> find_problem(const FrequencyResponseOptions& options) {
  using Excitation = FrequencyResponseOptions::Excitation;
  const Excitation excitation = excitation_of(options);
  if (!(options.overlap >= 0.0 && options.overlap < 1.0)) {
    return OptionProblem{"overlap", fmt::format("is {}", options.overlap), "must be from 0 to below 1"};
  }
  if (options.segment_length && *options.segment_length < 2) {
    return OptionProblem{"segment_length", fmt::format("is {}", *options.segment_length), "must be at least 2 samples"};
  }
  if (options.segment_length && excitation == Excitation::periodic && options.lines.empty()) {
    return OptionProblem{"segment_length", "is given for a periodic force",
                         "must be left out, or the force taken as aperiodic"};
  }
  if (options.period && *options.period < 2) {
    return OptionProblem{"period", fmt::format("is {}", *options.period), "must be at least 2 samples"};
  }
  if (options.skip_periods > 0 && excitation == Excitation::aperiodic) {
    return OptionProblem{"skip_periods", fmt::format("is {} for an aperiodic force", options.skip_periods),
                         "must be 0, or the force periodic"};
  }
  const auto wrong =
      std::ranges::find_if_not(options.lines, [](double line) { return std::isfinite(line) && line > 0.0; });
  if (wrong != options.lines.end())
    return OptionProblem{"lines", fmt::format("has {:.6g} Hz", hertz(*wrong)), "must be finite and above 0"};
  if (!options.lines.empty() && (options.segment_length || options.period)) {
    return OptionProblem{"lines", "are given beside a segment's length or a period",
                         "must be left out, or they: lines are fitted in the whole record"};
  }
  return find_band_problem(options);
}

}  // namespace zwidth
