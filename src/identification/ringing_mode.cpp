#include "identification/ringing_mode.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "identification/motion_residuals.hpp"
#include "identification/response/response_choice.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

struct RingingMode {
  double frequency = 0.0;                                  ///< rad/s
  double decay = std::numeric_limits<double>::infinity();  ///< 1/s
};

/// That which rings for longest of those that the lines see.
RingingMode longest_ringing(const RecordFit& found, const IdentifyOptions& options) try {
  const std::vector<ResponsePoint>& points = found.response.points;
  RingingMode longest;
  const Device device = device_in_experiment(found.fit.device, options.fit.locked, *found.response.sampling_period);
  for (const ModalTerm& term : modal_form(device).terms) {
    if (term.degree != 2) continue;
    const double frequency = std::sqrt(std::max(0.0, term.denominator[0]));
    const double decay = 0.5 * term.denominator[1];
    constexpr double below = 0.5;  // of the first line
    const bool is_seen = frequency > below * points.front().frequency && frequency < points.back().frequency;
    if (is_seen && decay > 0.0 && decay < frequency && decay < longest.decay) longest = {frequency, decay};
  }
  return longest;
} catch (const Error&) {  // no poles were found
  return {};
}

bool is_of_segments(const FrequencyResponse& response, std::span<const Recording> recordings,
                    const IdentifyOptions& options) {
  return !recordings.empty() && !is_of_lines(recordings, options.response) && response.sampling_period &&
         response.points.size() > 1;
}

}  // namespace

std::optional<std::size_t> segment_for_modes(const RecordFit& found, std::span<const Recording> recordings,
                                             const IdentifyOptions& options) {
  if (!is_of_segments(found.response, recordings, options) || options.response.segment_length) return std::nullopt;
  constexpr double died_out = 4.0;  // time constants
  constexpr std::size_t least_segments = 4;
  constexpr double notably = 1.25;
  std::size_t longest = std::numeric_limits<std::size_t>::max();
  for (const Recording& each : recordings) {
    longest = std::min(longest, each.channels[0].samples.size() / least_segments);
  }
  const double period = *found.response.sampling_period;
  const double wanted =
      std::min(died_out / longest_ringing(found, options).decay, static_cast<double>(longest) * period);
  if (!(wanted > notably * segment_duration(found.response))) return std::nullopt;
  return static_cast<std::size_t>(wanted / period);
}

std::optional<Finding> doubt_of_ringing(const Identification& found, std::span<const Recording> recordings,
                                        const IdentifyOptions& options) {
  const auto& limit = found.analysis.critical.limit;
  if (!is_of_segments(found.response, recordings, options) || !limit) return std::nullopt;
  const RingingMode mode = longest_ringing({found.fit, found.response}, options);
  constexpr double few = 2.0;  // time constants
  constexpr double near = 1.3;
  const double duration = segment_duration(found.response);
  const bool limits = limit->frequency < near * mode.frequency && near * limit->frequency > mode.frequency;
  if (!limits || mode.decay * duration >= few) return std::nullopt;
  return Finding{
      .code = FindingCode::segments_truncate_mode,
      .evidence = {{"frequency", hertz(mode.frequency)}, {"ringing", 1.0 / mode.decay}, {"segment", duration}}};
}

}  // namespace zwidth::internal
