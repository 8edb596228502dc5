#include "zwidth/identification/measured_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "identification/plausibility.hpp"
#include "signal/clipping.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

std::string sentence(const Remark& remark) {
  std::string text = remark.what;
  for (const std::string* part : {&remark.consequence, &remark.remedy}) {
    if (!part->empty()) text += "; " + *part;
  }
  return text;
}

std::optional<OptionProblem> find_band_problem(const FrequencyResponseOptions& options) {
  const auto wrong = [](const std::optional<double>& frequency) {
    return frequency && !(std::isfinite(*frequency) && *frequency > 0.0);
  };
  if (wrong(options.lowest)) {
    return OptionProblem{"lowest", fmt::format("is {} rad/s", *options.lowest), "must be finite and > 0"};
  }
  if (wrong(options.highest)) {
    return OptionProblem{"highest", fmt::format("is {} rad/s", *options.highest), "must be finite and > 0"};
  }
  if (options.lowest && options.highest && *options.lowest >= *options.highest) {
    return OptionProblem{"highest", fmt::format("is {} rad/s", *options.highest),
                         fmt::format("must be above lowest, {} rad/s", *options.lowest)};
  }
  return std::nullopt;
}

SignalRole role_of(OutputQuantity output) {
  switch (output) {
    case OutputQuantity::velocity:
      return SignalRole::velocity;
    case OutputQuantity::acceleration:
      return SignalRole::acceleration;
    case OutputQuantity::position:
      break;
  }
  return SignalRole::position;
}

/// What the stiffness that was read off the response rests on.
Trust trust_of(const MeasuredStiffness& stiffness) {
  Trust trust;
  const bool found = stiffness.status == MeasuredStiffnessStatus::found && stiffness.limit.has_value();
  bool has_reason = false;
  for (const Remark& remark : stiffness.remarks) {
    if (remark.severity != Remark::Severity::warning) continue;
    has_reason = true;
    found ? trust.doubt(sentence(remark)) : trust.refuse(sentence(remark));
  }
  if (!found && !has_reason) trust.refuse("the data prove no critical stiffness; excite a wider band, more strongly");
  return trust;
}

}  // namespace

std::optional<OptionProblem> find_problem(const FrequencyResponseOptions& options) {
  using Excitation = FrequencyResponseOptions::Excitation;
  if (!(options.overlap >= 0.0 && options.overlap < 1.0)) {
    return OptionProblem{"overlap", fmt::format("is {}", options.overlap), "must be from 0 to below 1"};
  }
  if (options.segment_length && *options.segment_length < 2) {
    return OptionProblem{"segment_length", fmt::format("is {}", *options.segment_length), "must be at least 2 samples"};
  }
  if (options.segment_length && options.excitation == Excitation::periodic) {
    return OptionProblem{"segment_length", "is given for a periodic force",
                         "must be left out, or the force taken as aperiodic"};
  }
  if (options.period && *options.period < 2) {
    return OptionProblem{"period", fmt::format("is {}", *options.period), "must be at least 2 samples"};
  }
  if (options.skip_periods > 0 && options.excitation == Excitation::aperiodic) {
    return OptionProblem{"skip_periods", fmt::format("is {} for an aperiodic force", options.skip_periods),
                         "must be 0, or the force periodic"};
  }
  return find_band_problem(options);
}

MeasuredResponse judged_response(std::string source, FrequencyResponse response, std::vector<Remark> remarks) {
  MeasuredResponse measured{std::move(source), std::move(response), std::nullopt, std::move(remarks), {}};
  std::vector<Remark>& own = measured.response.remarks;
  std::move(own.begin(), own.end(), std::back_inserter(measured.remarks));
  own.clear();
  const auto without_stiffness = [&measured](Remark remark) {
    measured.trust.refuse(sentence(remark));
    measured.remarks.push_back(std::move(remark));
  };
  if (!measured.response.sampling_period) {
    without_stiffness({Remark::Severity::warning, "a response without a sampling rate",
                       "hold and delay are not in it, so that it has no critical stiffness; give the rate of a "
                       "sampled one, or fit a device to it"});
  } else if (measured.response.points.size() < 2) {
    without_stiffness(
        {Remark::Severity::warning, "a response of a single line", "crossovers lie between lines: excite a band"});
  } else {
    measured.stiffness = measured_stiffness(measured.response);
    const std::vector<Remark>& found = measured.stiffness->remarks;
    measured.remarks.insert(measured.remarks.end(), found.begin(), found.end());
    measured.trust = trust_of(*measured.stiffness);
  }
  return measured;
}

MeasuredResponse frequency_response(const Recording& recording, const FrequencyResponseOptions& options,
                                    const Progress& progress) {
  if (recording.channels.size() != 2) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("the recording has {} channels; two, the force and the motion", recording.channels.size()));
  }
  if (const auto problem = find_problem(options)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("{} {}; {}", problem->member, problem->what, problem->allowed));
  }
  FrequencyResponse response = frequency_response(recording.channels[0].samples, recording.channels[1].samples,
                                                  recording.sampling_period, options, progress);
  if (response.points.empty()) {
    throw Error(ErrorCode::invalid_argument, "no line is left in the band asked for; widen it");
  }
  std::vector<Remark> remarks = recording.remarks;
  const std::array roles{SignalRole::force, role_of(options.output)};
  std::vector<std::string> doubts;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const Channel& channel = recording.channels[i];
    for (Remark& remark : check_signal(channel, recording.sampling_period, roles[i])) {
      remarks.push_back(std::move(remark));
    }
    if (is_clipped(channel, recording.sampling_period, roles[i])) {
      doubts.push_back(fmt::format("{} is clipped: the response is not that of a linear device; reduce the amplitude",
                                   channel.name));
    }
  }
  for (Remark& remark : implausible_recording(recording)) remarks.push_back(std::move(remark));
  MeasuredResponse measured = judged_response(recording.source, std::move(response), std::move(remarks));
  for (const std::string& doubt : doubts) measured.trust.doubt(doubt);
  return measured;
}

std::vector<ResponseLine> response_lines(const FrequencyResponse& response) {
  constexpr double turn = 2.0 * std::numbers::pi;
  std::vector<ResponseLine> lines;
  for (const ResponsePoint& measured : response.points) {
    ResponseLine line;
    line.frequency = measured.frequency;
    line.magnitude = std::abs(measured.value);
    line.coherence = measured.coherence;
    line.phase = std::arg(measured.value);
    if (lines.empty()) {
      if (line.phase > 0.25 * turn) line.phase -= turn;
    } else {
      line.phase += turn * std::round((lines.back().phase - line.phase) / turn);
    }
    const double radius = confidence_radius(measured, response.averages);
    if (std::isfinite(radius)) {
      line.magnitude_lower = std::max(0.0, line.magnitude - radius);
      line.magnitude_upper = line.magnitude + radius;
      if (radius < line.magnitude) {
        const double half_width = std::asin(radius / line.magnitude);
        line.phase_lower = line.phase - half_width;
        line.phase_upper = line.phase + half_width;
      }
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace zwidth
