#include <algorithm>
#include <cmath>
#include <utility>

#include "counted.hpp"
#include "identification/device_file_trust.hpp"
#include "identification/likelihood_fit.hpp"
#include "identification/limit_of_response.hpp"
#include "identification/line_fit.hpp"
#include "identification/model/segment_player.hpp"
#include "identification/response/plausibility.hpp"
#include "identification/response/response_choice.hpp"
#include "identification/response_of_device.hpp"
#include "identification/verdict/assumed_experiment.hpp"
#include "identification/verdict/plausible_device.hpp"
#include "identification/verdict/turned_sign.hpp"
#include "identification/verdict/verdict.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t least_samples_of_motion = 300;
constexpr auto most_bodies_of_motion = static_cast<std::size_t>(SegmentPlayer::most_bodies);

IdentifyOptions::Method method_of(std::span<const Recording> recordings, const Device& structure,
                                  const IdentifyOptions& options) {
  const bool is_long = std::ranges::all_of(recordings, [](const Recording& each) {
    return each.channels.size() == 2 && each.channels[1].samples.size() >= least_samples_of_motion;
  });
  const bool has_motion = options.response.output == OutputQuantity::position && is_long &&
                          structure.bodies().size() <= most_bodies_of_motion;
  return options.method.value_or(has_motion ? IdentifyOptions::Method::motion : IdentifyOptions::Method::lines);
}

/// Where the motion was asked for.
void check_motion(std::span<const Recording> recordings, const Device& structure, const IdentifyOptions& options) {
  if (options.method != IdentifyOptions::Method::motion) return;
  if (structure.bodies().size() > most_bodies_of_motion)
    refuse_member("method",
                  {.code = ProblemCode::motion_not_fitted,
                   .evidence = {counted("bodies", structure.bodies().size()), counted("most", most_bodies_of_motion)}});
  for (const Recording& each : recordings) {
    if (each.channels.size() == 2 && each.channels[1].samples.size() < least_samples_of_motion)
      refuse_member("method", {.code = ProblemCode::motion_not_fitted,
                               .evidence = {counted("samples", each.channels[1].samples.size()),
                                            counted("least", least_samples_of_motion)}});
  }
}

bool frees_lateness(const IdentifyOptions& options) {
  using enum IdentifyOptions::LoopDelay;
  return options.loop_delay == by_free ? frees_all(options.fit.free) : options.loop_delay == from_data;
}

bool is_known(const IdentifyOptions& options) {
  return options.structure_values == IdentifyOptions::StructureValues::known;
}

/// What the data say before anything is fitted.
FittedLikelihood before_fit(const MeasuredResponse& measured, const Device& structure, std::vector<Finding> doubts) {
  FittedLikelihood fit{.motion = structure.parameters().motion, .doubts_of_data = std::move(doubts)};
  if (auto turned = turned_sign(measured.response)) fit.contradictions.push_back(*std::move(turned));
  for (const Finding& each : measured.trust.findings) {
    if (each.code == FindingCode::clipped_for_response) fit.doubts_of_data.push_back(each);
  }
  return fit;
}

/// Why no answer of these recordings is one of the structure's loop.
std::vector<Finding> doubts_of(std::span<const Recording> recordings, const Device& structure,
                               const IdentifyOptions& options) {
  std::vector<Finding> doubts;
  for (const Recording& each : recordings) {
    std::ranges::move(doubts_of_recording(each, recordings, options.response.output, structure),
                      std::back_inserter(doubts));
  }
  return doubts;
}

/// The remarks, less those of the limit that the response alone shows, which a fit does not ask.
std::vector<Remark> remarks_of_fit(const MeasuredResponse& measured) {
  std::vector<Remark> remarks = measured.remarks;
  std::erase_if(remarks, [&](const Remark& remark) {
    const auto is_it = [&](const Remark& other) { return other.finding && other.finding == remark.finding; };
    const bool is_of_response = remark.finding && (remark.finding->code == FindingCode::friction_unknown ||
                                                   remark.finding->code == FindingCode::table_hides_friction);
    return is_of_response || (measured.stiffness && std::ranges::any_of(measured.stiffness->remarks, is_it));
  });
  return remarks;
}

/// The range of a found limit; nothing where the data say next to nothing of it.
std::optional<Interval> told_limit(const Interval& interval) {
  constexpr double widest = 1000.0;
  const bool is_told = interval.lower > 0.0 && interval.upper <= widest * interval.lower;
  return is_told ? std::optional(interval) : std::nullopt;
}

/// Whether fewer numbers of a response stand out of their noise than are fitted.
bool is_drowned(const FrequencyResponse& response, const Device& structure, const IdentifyOptions& options) {
  constexpr double clear = 3.0;
  const auto standing_out = std::ranges::count_if(response.points, [](const ResponsePoint& point) {
    return std::norm(point.value) > clear * clear * point.variance;
  });
  return 2 * static_cast<std::size_t>(standing_out) <
         free_parameters(structure, options.fit.free, options.fit.locked).size();
}

ParameterEstimate undetermined_estimate(const std::string& key, const Device& structure) {
  ParameterEstimate estimate;
  estimate.key = key;
  estimate.value = parameter(structure.parameters(), key).value_or(0.0);
  estimate.identifiable = false;
  return estimate;
}

/// What was found, in the answer and before the judge. `known`: the structure, where its numbers are the device's.
void take_found(const FoundDevice& found, const Device* known, Identification& result, FittedLikelihood& fit) {
  result.fit = {.device = device_of(found),
                .estimates = estimates_of(found),
                .correlations = correlations_of(found),
                .unidentifiable = open_numbers_of(found),
                .misfit = {},
                .settled = found.last_change == 0.0};
  result.rivals = rival_table(found.best, found.rivals);
  fit.rivals = result.rivals;
  fit.last_change = found.last_change;
  if (auto doubt = doubt_of_masses(result.fit.device, known)) fit.doubts_of_data.push_back(*std::move(doubt));
  std::ranges::move(implausible_device(result.fit.device, known, result.response.sampling_period),
                    std::back_inserter(result.remarks));
}

std::optional<LimitPlace> place_of_limit(const Identification& result) {
  const std::optional<Crossover>& limit = result.analysis.critical.limit;
  if (!limit || result.fit.frequencies.empty()) return std::nullopt;
  return LimitPlace{hertz(limit->frequency), hertz(result.fit.frequencies.front()),
                    hertz(result.fit.frequencies.back())};
}

/// The interval of the fit is that of the limit without damper and filters, which was fitted.
void take_interval(const Interval& interval, Identification& result) {
  const Wall& wall = result.fit.device.parameters().wall;
  if (!result.analysis.interval || wall.damping != 0.0 || !wall.filters.empty()) return;
  result.analysis.interval->lower = std::min(interval.lower, result.analysis.critical.stiffness);
  result.analysis.interval->upper = std::max(interval.upper, result.analysis.critical.stiffness);
}

/// The trust of the answer with that of its limit, and of what stays assumed; into the device and the analysis.
void spread_trust(const Device& structure, const IdentifyOptions& options, Identification& result) {
  if (!result.trust.refused() && result.analysis.critical.trust.refused())
    result.trust.inherit(result.analysis.critical.trust);
  keep_what_is_assumed(structure, result.fit.estimates,
                       is_known(options) ? std::vector<std::string>{} : unseen_placeholders(options.fit.locked),
                       result.fit.device, result.trust);
  result.fit.device = with_trust(result.fit.device, result.trust);
  if (result.trust.refused()) result.analysis = analyze(result.fit.device, {.any_user = false});
  result.analysis.trust.inherit(result.trust);
}

/// The device, its analysis and the verdict on it, of what was found and is known of it.
Identification judged(const MeasuredResponse& measured, const Device& structure, const IdentifyOptions& options,
                      std::optional<FoundDevice> found, FittedLikelihood fit, IdentifyOptions::Method method) {
  Identification result{.source = measured.source,
                        .method = method,
                        .response = measured.response,
                        .fit = {.device = structure, .misfit = {}}};
  result.remarks = remarks_of_fit(measured);
  if (found) {
    Interval& interval = found->best.interval;
    fit.limit = told_limit(interval);
    if (!is_explained(fit))
      interval = with_limit_of_response(interval, measured.response, structure, options.fit.locked);
    take_found(*found, is_known(options) ? &structure : nullptr, result, fit);
  } else {
    for (const std::string& key : free_parameters(structure, options.fit.free, options.fit.locked))
      result.fit.estimates.push_back(undetermined_estimate(key, structure));
  }
  compare_with_response(result.fit, measured.response, options.fit);
  result.analysis = analyze(result.fit.device, {.any_user = false});
  if (found) fit.place = place_of_limit(result);
  Verdict verdict = verdict_of(fit);
  result.trust = std::move(verdict.trust);
  std::ranges::move(verdict.remarks, std::back_inserter(result.remarks));
  std::ranges::move(assumptions_of_experiment(structure, is_known(options), options.fit.locked),
                    std::back_inserter(result.remarks));
  const Wall& wall = result.fit.device.parameters().wall;
  result.basis = {wall.damping, wall.velocity_filter_hz, wall.filters.size()};
  if (found) take_interval(found->best.interval, result);
  spread_trust(structure, options, result);
  return result;
}

/// A device found from lines or limits, in the words of one found from its motion.
FoundDevice found_device(const FittedByLines& fitted, const Device& structure, const IdentifyOptions& options) {
  FoundDevice found{.device = fitted.device, .best = {}, .last_change = fitted.last_change};
  found.best = {.numbers = fitted.numbers,
                .x = fitted.x,
                .covariance = fitted.covariance,
                .stiffness_slope = fitted.slope,
                .stiffness = fitted.value,
                .interval = {fitted.lower, fitted.upper},
                .motion = structure.parameters().motion};
  const std::vector<std::string> free = free_parameters(structure, options.fit.free, options.fit.locked);
  const std::string spring = "body." + structure.bodies()[structure.loop().held].name + ".stiffness";
  for (const Number& number : fitted.numbers) {
    if (std::ranges::count(free, number.key) > 0) continue;
    if (number.key == key_of_lag) found.rivals.push_back({"actuator_lag", {number.key}, RivalMeasure::time});
    if (number.key == spring) found.rivals.push_back({"ground_spring", {number.key}, RivalMeasure::stiffness});
  }
  return found;
}

Identification identified_by_lines(const MeasuredResponse& measured, const Device& structure,
                                   const IdentifyOptions& options, std::vector<Finding> doubts = {},
                                   bool motion_tells_none = false) {
  const FrequencyResponse response = band_of(measured.response, options.fit);
  FittedLikelihood fit = before_fit(measured, structure, std::move(doubts));
  fit.motion_tells_none = motion_tells_none;
  if (!fit.contradictions.empty() || is_drowned(response, structure, options))
    return judged(measured, structure, options, std::nullopt, std::move(fit), IdentifyOptions::Method::lines);
  const auto fitted = fit_lines({.structure = structure,
                                 .response = &response,
                                 .limits = options.limits,
                                 .free = options.fit.free,
                                 .locked = options.fit.locked,
                                 .known = is_known(options),
                                 .frees_lateness = frees_lateness(options)});
  std::optional<FoundDevice> found;
  if (fitted) {
    found = found_device(*fitted, structure, options);
    fit.left = fitted->left;
    fit.records = {{measured.source, response.sampling_period.value_or(0.0)}};
  }
  return judged(measured, structure, options, std::move(found), std::move(fit), IdentifyOptions::Method::lines);
}

Identification identified_by_motion(std::span<const Recording> recordings, const MeasuredResponse& measured,
                                    const Device& structure, const IdentifyOptions& options,
                                    std::vector<Finding> doubts, const Progress& progress) {
  double done = 0.0;
  const auto tell = [&] {
    constexpr double of_rest = 0.02;  // how many steps there will be is not known
    done += of_rest * (1.0 - done);
    if (progress) progress(done);
  };
  FittedLikelihood fit = before_fit(measured, structure, doubts);
  if (!fit.contradictions.empty() || is_drowned(measured.response, structure, options))
    return judged(measured, structure, options, std::nullopt, std::move(fit), IdentifyOptions::Method::motion);
  const bool is_start = options.fit.start == ParameterFitOptions::Start::from_structure;
  const auto fitted = fit_by_likelihood(recordings, measured.response, structure,
                                        {{options.fit.free, options.fit.locked, frees_lateness(options), is_start},
                                         options.segment,
                                         options.limits,
                                         tell});
  if (!fitted || !told_limit(fitted->found.best.interval))
    return identified_by_lines(measured, structure, options, std::move(doubts), true);
  fit.left = fitted->left;
  fit.delay = fitted->delay;
  fit.doubts_of_data.insert(fit.doubts_of_data.end(), fitted->contradicted.begin(), fitted->contradicted.end());
  for (const Recording& each : recordings) fit.records.push_back({each.source, each.sampling_period});
  Identification result =
      judged(measured, structure, options, fitted->found, std::move(fit), IdentifyOptions::Method::motion);
  result.motions = fitted->motions;
  return result;
}

}  // namespace

Identification identify(const Recording& recording, const Device& structure, const IdentifyOptions& options,
                        const Progress& progress) {
  return identify(std::span(&recording, 1), structure, options, progress);
}

Identification identify(std::span<const Recording> recordings, const Device& structure, const IdentifyOptions& options,
                        const Progress& progress) {
  require_no_coordinates(structure);
  require_open_damper(structure);
  require_valid(find_problem(options));
  check_motion(recordings, structure, options);
  const MeasuredResponse measured = response_with_enough_lines(recordings, structure, options, {});
  if (method_of(recordings, structure, options) == IdentifyOptions::Method::lines)
    return identified_by_lines(measured, structure, options, doubts_of(recordings, structure, options));
  return identified_by_motion(recordings, measured, structure, options, doubts_of(recordings, structure, options),
                              progress);
}

Identification identify(const MeasuredResponse& measured, const Device& structure, const IdentifyOptions& options) {
  require_no_coordinates(structure);
  require_open_damper(structure);
  require_valid(find_problem(options));
  return identified_by_lines(measured, structure, options);
}

Identification identify_from_limits(const Device& structure, const IdentifyOptions& options) {
  require_no_coordinates(structure);
  require_one_rate(structure);
  require_valid(find_problem(options));
  if (options.limits.empty()) refuse_member("limits", {.code = ProblemCode::no_values});
  const auto fitted = fit_lines({.structure = structure,
                                 .limits = options.limits,
                                 .free = options.fit.free,
                                 .locked = options.fit.locked,
                                 .known = is_known(options)});
  std::optional<FoundDevice> found;
  if (fitted) found = found_device(*fitted, structure, options);
  MeasuredResponse none;
  none.source = "measured limits";
  FittedLikelihood fit{.motion = structure.parameters().motion};
  if (fitted) fit.left = fitted->left;
  fit.records = {{none.source, 0.0}};
  return judged(none, structure, options, found, std::move(fit), IdentifyOptions::Method::lines);
}

}  // namespace zwidth
