#include "zwidth/identification/measured_response.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "counted.hpp"
#include "identification/response/hidden_friction.hpp"
#include "identification/response/local_polynomial.hpp"
#include "identification/response/plausibility.hpp"
#include "identification/response/pooled_response.hpp"
#include "identification/response/response_choice.hpp"
#include "identification/response/stated_units.hpp"
#include "identification/response/welch.hpp"
#include "identification/verdict/calibration.hpp"
#include "signal/clipping.hpp"
#include "words/phrase.hpp"
#include "words/stated_quantity.hpp"
#include "zwidth/error.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// As one of several recordings shows it; an empty source is that of one alone.
Finding shown_in(const std::string& source, Finding finding) {
  if (!source.empty()) finding.subjects.push_back({of_recording, source});
  return finding;
}

Remark shown_in(const std::string& source, Remark remark) {
  if (source.empty()) return remark;
  if (remark.finding) remark.finding = shown_in(source, *std::move(remark.finding));
  remark.what = source + ": " + remark.what;
  return remark;
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
    // Its interval is as wide as the lines leave the peak open.
    if (found && remark.finding->code == FindingCode::lines_too_far_apart) continue;
    found ? trust.doubt(remark.finding.value()) : trust.refuse(remark.finding.value());
  }
  if (!found && !has_reason) trust.refuse({.code = FindingCode::no_limit_proven});
  return trust;
}

constexpr std::size_t fewest_samples = 16;

void check(std::span<const Recording> recordings, const FrequencyResponseOptions& options) {
  const auto require = [](bool holds, const Problem& problem) {
    if (!holds) throw Error(ErrorCode::invalid_argument, problem);
  };
  require_valid(find_problem(options));
  require(!recordings.empty(), {.code = ProblemCode::no_recording});
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const Recording& each = recordings[r];
    require(each.channels.size() == 2, {.code = ProblemCode::recording_without_two_channels,
                                        .evidence = {counted("channels", each.channels.size())}});
    require(std::isfinite(each.sampling_period) && each.sampling_period > 0.0,
            {.code = ProblemCode::not_finite_and_positive,
             .evidence = {{"value", each.sampling_period}},
             .subjects = {{"name", each.source + ": sampling period"}, {"unit", "s"}}});
    for (std::size_t before = 0; before < r; ++before) {
      require(each.channels[1].samples.empty() || each.channels[0].samples != recordings[before].channels[0].samples ||
                  each.channels[1].samples != recordings[before].channels[1].samples,
              {.code = ProblemCode::recording_twice,
               .subjects = {{"source", each.source}, {"other", recordings[before].source}}});
    }
  }
}

/// What a recording's signals show before any estimate.
struct RecordChecks {
  std::vector<Remark> remarks;
  std::vector<Finding> doubts;
};

RecordChecks checked(const Recording& recording, OutputQuantity output) {
  RecordChecks found{recording.remarks, {}};
  const std::array roles{SignalRole::force, role_of(output)};
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const Channel& channel = recording.channels[i];
    for (Remark& remark : check_signal(channel, recording.sampling_period, roles[i])) {
      found.remarks.push_back(std::move(remark));
    }
    if (is_clipped(channel, recording.sampling_period, roles[i])) {
      found.doubts.push_back({.code = FindingCode::clipped_for_response, .subjects = {{"channel", channel.name}}});
    }
  }
  for (Remark& remark : implausible_recording(recording)) found.remarks.push_back(std::move(remark));
  if (auto doubt = doubt_of_units(recording, output)) found.doubts.push_back(*std::move(doubt));
  return found;
}

constexpr double other_force = 1.2;  // times another: more tells what hangs on it

/// Says that recordings disagree, and whether that moves the critical stiffness.
void judge_dependence(MeasuredResponse& measured, std::span<const Recording> recordings,
                      std::span<const FrequencyResponse> each) {
  const AmplitudeDependence& found = *measured.dependence;
  const bool by_force = found.force_ratio > other_force;
  Finding shown{.code = FindingCode::recordings_differ,
                .evidence = {{"difference", found.difference}, counted("lines", found.lines)}};
  if (by_force) {
    shown.code =
        found.grows_with_force ? FindingCode::response_depends_as_by_friction : FindingCode::response_depends_on_force;
    shown.evidence.push_back({"times", found.force_ratio});
    shown.evidence.push_back({"threshold", other_force});
    if (found.grows_with_force && found.friction) {
      shown.evidence.push_back({"friction", *found.friction});
      shown.subjects.push_back({"force", force_in_words(*found.friction, measured.force_unit)});
    }
  }
  measured.remarks.push_back(warning(shown));
  if (measured.trust.refused() || !measured.stiffness || !stiffness_interval(*measured.stiffness)) return;
  const Interval interval = *stiffness_interval(*measured.stiffness);
  std::vector<std::string> moved;
  std::size_t compared = 0;
  Interval values{std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t r = 0; r < each.size(); ++r) {
    if (each[r].points.size() < 2) continue;
    const MeasuredStiffness alone = measured_stiffness(each[r]);
    const auto own = stiffness_interval(alone);
    if (!own) continue;
    ++compared;
    const double stiffness = alone.limit->stiffness;
    values = {std::min(values.lower, stiffness), std::max(values.upper, stiffness)};
    const bool is_within = stiffness >= interval.lower && stiffness <= interval.upper;
    const double pooled = measured.stiffness->limit->stiffness;
    if (is_within || (own->lower <= pooled && pooled <= own->upper)) continue;
    moved.push_back(fmt::format("{:.4g} from {}", stiffness, recordings[r].source));
  }
  // What force does to it goes on beyond the recorded ones.
  constexpr double harmless = 1.05;
  if (compared < 2 || (by_force && values.upper > harmless * values.lower)) {
    measured.trust.doubt(std::move(shown));
  } else if (!moved.empty()) {
    measured.trust.doubt({.code = FindingCode::recordings_disagree_on_limit,
                          .evidence = {{"lower", interval.lower}, {"upper", interval.upper}},
                          .subjects = {{"stiffnesses", fmt::format("{}", fmt::join(moved, ", "))}}});
  }
}

/// What a table says of itself: a stiffness that was refused where it was measured is none.
void inherit(MeasuredResponse& measured, const Trust& source) {
  measured.trust.inherit(source);
  const Finding without_reason{.code = FindingCode::table_gives_no_reason};
  if (source.verdict == Trust::Verdict::doubtful && source.reasons.empty()) measured.trust.doubt(without_reason);
  if (!source.refused()) return;
  if (source.reasons.empty()) measured.trust.refuse(without_reason);
  if (measured.stiffness && measured.stiffness->status == MeasuredStiffnessStatus::found)
    measured.stiffness->status = MeasuredStiffnessStatus::undetermined;
}

bool is_narrow(const Interval& interval) { return interval.upper <= Calibration::widest_interval * interval.lower; }

/// Doubts a critical stiffness whose interval is too wide.
void judge_width(MeasuredResponse& measured) {
  if (!measured.stiffness || measured.trust.refused()) return;
  const auto interval = stiffness_interval(*measured.stiffness);
  if (!interval || is_narrow(*interval)) return;
  Finding open{
      .code = FindingCode::data_leave_interval_open,
      .evidence = {{"lower", interval->lower}, {"upper", interval->upper}, {"threshold", Calibration::widest_interval}},
      .effect = {{"critical_stiffness", interval->lower}}};
  if (interval->lower > 0.0) open.evidence.push_back({"factor", interval->upper / interval->lower});
  measured.trust.doubt(std::move(open));
}

/// The interval reaches down to the critical stiffness without as much friction as the recordings leave open: a response takes
/// friction for damping. What shows of it is a lower bound alone, and a doubt.
void judge_width_with_friction(MeasuredResponse& measured, std::span<const Recording> recordings,
                               std::span<const FrequencyResponse> each, const FrequencyResponseOptions& options) {
  if (!measured.stiffness || measured.trust.refused() || !stiffness_interval(*measured.stiffness)) return;
  const auto forces = hidden_forces(recordings, each, options);
  if (!forces) {
    measured.remarks.push_back(note({.code = FindingCode::friction_unknown}));
    return judge_width(measured);
  }
  const auto& [friction, drag] = *forces;
  if (measured.dependence && measured.dependence->grows_with_force && friction.shows()) {
    measured.dependence->friction = friction.size;
    measured.dependence->friction_deviation = friction.deviation;
  }
  const auto before = stiffness_interval(*measured.stiffness);
  const auto without = [&](double of_friction, double of_drag) {
    const auto found =
        measured_stiffness(without_forces(measured.response, {{of_friction}, {of_drag}}, recordings, options));
    return found.status == MeasuredStiffnessStatus::found && found.limit ? found.limit->stiffness : 0.0;
  };
  const double remaining = std::min(without(friction.most(), drag.size), without(friction.size, drag.most()));
  // What shows is taken off; beyond it, noise and what is left open of the two are independent.
  const double shown = std::min(without(friction.size, drag.size), measured.stiffness->limit->stiffness);
  const double least =
      remaining > 0.0 && before->lower > 0.0
          ? std::min(before->lower,
                     shown * std::exp(-std::hypot(std::log(measured.stiffness->limit->stiffness / before->lower),
                                                  std::log(std::max(1.0, shown / remaining)))))
          : 0.0;
  MeasuredCrossover& limit = *measured.stiffness->limit;
  for (MeasuredCrossover& crossover : measured.stiffness->crossovers) {
    if (crossover.frequency == limit.frequency) crossover.stiffness_interval.lower = least;
  }
  limit.stiffness_interval.lower = std::min(limit.stiffness_interval.lower, least);
  const auto doubt_by = [&](FindingCode code, double size) {
    Finding found{.code = code,
                  .evidence = {{"friction", size}},
                  .subjects = {{"force", force_in_words(size, measured.force_unit)}}};
    if (remaining > 0.0) {
      found.subjects.push_back({"stiffness", stiffness_in_words(remaining, measured.force_unit, measured.length_unit)});
      found.effect.push_back({"critical_stiffness", remaining});
    }
    measured.trust.doubt(std::move(found));
  };
  if (friction.shows()) doubt_by(FindingCode::motion_shows_friction, friction.size);
  if (drag.shows()) measured.trust.doubt({.code = FindingCode::motion_shows_drag, .evidence = {{"drag", drag.size}}});
  const bool friction_alone_widens = is_narrow(*before) && !is_narrow({least, before->upper});
  if (!friction_alone_widens) return judge_width(measured);
  if (!friction.shows()) doubt_by(FindingCode::friction_would_pass_unseen, friction.most());
}

/// Whether one of the forces is notably larger than another.
bool has_several_amplitudes(std::span<const Recording> recordings) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Recording& each : recordings) {
    double squares = 0.0;
    for (const double force : each.channels[0].samples) squares += force * force;
    const double rms = std::sqrt(squares / static_cast<double>(each.channels[0].samples.size()));
    least = std::min(least, rms);
    most = std::max(most, rms);
  }
  return most > other_force * least;
}

/// The response and what it shows of the critical stiffness.
MeasuredResponse judged(std::string source, FrequencyResponse response, std::vector<Remark> remarks) {
  MeasuredResponse measured{std::move(source), std::move(response), std::nullopt, std::move(remarks), {}};
  std::vector<Remark>& own = measured.response.remarks;
  std::move(own.begin(), own.end(), std::back_inserter(measured.remarks));
  own.clear();
  const auto without_stiffness = [&measured](FindingCode code) {
    measured.trust.refuse({.code = code});
    measured.remarks.push_back(warning({.code = code}));
  };
  if (!measured.response.sampling_period) {
    without_stiffness(FindingCode::response_without_rate);
  } else if (measured.response.points.size() < 2) {
    without_stiffness(FindingCode::response_of_one_line);
  } else {
    measured.stiffness = measured_stiffness(measured.response);
    const std::vector<Remark>& found = measured.stiffness->remarks;
    measured.remarks.insert(measured.remarks.end(), found.begin(), found.end());
    measured.trust = trust_of(*measured.stiffness);
  }
  if (measured.response.trust) inherit(measured, *measured.response.trust);
  return measured;
}

}  // namespace

MeasuredResponse judged_response(std::string source, FrequencyResponse response, std::vector<Remark> remarks) {
  MeasuredResponse measured = judged(std::move(source), std::move(response), std::move(remarks));
  if (!measured.response.trust && measured.stiffness && !measured.trust.refused()) {
    measured.remarks.push_back(note({.code = FindingCode::table_hides_friction}));
  }
  judge_width(measured);
  return measured;
}

namespace internal {

std::vector<FrequencyResponse> responses(std::span<const Recording> recordings, const FrequencyResponseOptions& options,
                                         const Progress& progress) {
  check(recordings, options);
  const double first_period = recordings.front().sampling_period;
  std::optional<double> segment;  // samples of the first: segments of one duration have lines in common
  if (options.segment_length) segment = static_cast<double>(*options.segment_length);
  if (recordings.size() > 1 && !options.segment_length) {
    for (const Recording& each : recordings) {
      const std::size_t samples = each.channels[0].samples.size();
      if (samples < fewest_samples) continue;  // refused below
      const double own =
          static_cast<double>(welch_segment_length(samples, options)) * (each.sampling_period / first_period);
      segment = std::min(segment.value_or(own), own);
    }
  }
  const double least_period = std::ranges::min(recordings, {}, &Recording::sampling_period).sampling_period;
  const auto options_of = [&](const Recording& each) {  // lengths in samples are those of the first
    FrequencyResponseOptions own = options;
    const double samples = first_period / each.sampling_period;
    if (segment) own.segment_length = static_cast<std::size_t>(std::lround(*segment * samples));
    // A line that only the faster recordings can hold.
    std::erase_if(own.lines, [&](double line) {
      return line * each.sampling_period >= std::numbers::pi && line * least_period < std::numbers::pi;
    });
    if (options.period)
      own.period = static_cast<std::size_t>(std::lround(static_cast<double>(*options.period) * samples));
    return own;
  };
  std::vector<FrequencyResponse> found;
  const auto count = static_cast<double>(recordings.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const Recording& each = recordings[r];
    const Progress part = [&](double fraction) {
      if (progress) progress((static_cast<double>(r) + fraction) / count);
    };
    try {
      found.push_back(frequency_response(each.channels[0].samples, each.channels[1].samples, each.sampling_period,
                                         recordings.size() > 1 ? options_of(each) : options, part));
      if (found.back().points.empty()) refuse_nothing_left(each, options);
    } catch (const Error& error) {
      if (recordings.size() == 1) throw;
      std::vector<InputProblem> problems = error.problems();
      for (InputProblem& problem : problems) problem.place.file = each.source;
      throw Error(error.code(), fmt::format("{}: {}", each.source, error.what()), std::move(problems));
    }
  }
  return found;
}

}  // namespace internal

MeasuredResponse frequency_response(const Recording& recording, const FrequencyResponseOptions& options,
                                    const Progress& progress) {
  return frequency_response(std::span(&recording, 1), options, progress);
}

namespace {

/// The response of each recording, pooled and judged.
MeasuredResponse judged(std::span<const Recording> recordings, std::span<const FrequencyResponse> each,
                        const FrequencyResponseOptions& decided) {
  std::vector<Remark> remarks;
  std::vector<Finding> doubts;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const std::string source = recordings.size() > 1 ? recordings[r].source : "";
    const RecordChecks checks = checked(recordings[r], decided.output);
    for (const Remark& remark : checks.remarks) remarks.push_back(shown_in(source, remark));
    for (const Finding& doubt : checks.doubts) doubts.push_back(shown_in(source, doubt));
    if (recordings.size() == 1) continue;
    for (const Remark& remark : each[r].remarks) remarks.push_back(shown_in(source, remark));
  }
  MeasuredResponse measured;
  if (recordings.size() == 1) {
    measured = judged(recordings[0].source, each[0], std::move(remarks));
  } else {
    PooledResponse pooled = pooled_response(each);
    measured = judged(fmt::format("{} and {} more", recordings[0].source, recordings.size() - 1),
                      std::move(pooled.response), std::move(remarks));
    measured.dependence = pooled.dependence;
  }
  state_units(measured, recordings);
  judge_width_with_friction(measured, recordings, each, decided);
  if (measured.dependence) judge_dependence(measured, recordings, each);
  if (measured.trust.sound() && !has_several_amplitudes(recordings))
    measured.remarks.push_back(note({.code = FindingCode::one_amplitude}));
  for (const Finding& doubt : doubts) measured.trust.doubt(doubt);
  return measured;
}

/// Of the interval's upper end to its lower one; infinite where there is none.
double width_of(const MeasuredResponse& measured) {
  const auto interval = measured.stiffness ? stiffness_interval(*measured.stiffness) : std::nullopt;
  return interval && interval->lower > 0.0 ? interval->upper / interval->lower
                                           : std::numeric_limits<double>::infinity();
}

}  // namespace

MeasuredResponse frequency_response(std::span<const Recording> recordings, const FrequencyResponseOptions& options,
                                    const Progress& progress) {
  FrequencyResponseOptions decided = options;
  decided.excitation = excitation_of(options);
  MeasuredResponse best = judged(recordings, responses(recordings, decided, progress), decided);
  if (options.segment_length || best.response.points.size() < 2 || is_of_lines(recordings, decided)) return best;
  if (width_of(best) <= Calibration::widest_interval) return best;
  // The whole record has closer lines than its segments, which leave the critical stiffness open.
  double shortest = std::numeric_limits<double>::infinity();  // s
  for (const Recording& each : recordings)
    shortest = std::min(shortest, static_cast<double>(each.channels[0].samples.size()) * each.sampling_period);
  constexpr double most_lines = 600.0;
  const double spacing = std::max(fewest_local_lines * 2.0 * std::numbers::pi / shortest,
                                  best.response.points.back().frequency / most_lines);
  std::vector<FrequencyResponse> whole;
  for (const Recording& each : recordings) {
    whole.push_back(response_of_whole_record(each.channels[0].samples, each.channels[1].samples, each.sampling_period,
                                             spacing, decided));
    if (whole.back().points.empty()) return best;
  }
  MeasuredResponse closer = judged(recordings, whole, decided);
  const bool is_better = width_of(closer) < width_of(best) || (best.trust.refused() && !closer.trust.refused());
  return is_better ? closer : best;
}

}  // namespace zwidth
