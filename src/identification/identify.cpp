#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "identification/data_check.hpp"
#include "identification/fit_method.hpp"
#include "identification/judged_identification.hpp"
#include "identification/motion_fit.hpp"
#include "identification/response/response_choice.hpp"
#include "identification/response_fit.hpp"
#include "identification/response_of_device.hpp"
#include "identification/verdict/widening.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// A device found from lines or limits, in the words of one found from its motion.
FoundDevice found_device(const ResponseFit& fitted, const Device& structure) {
  FoundDevice found{.device = fitted.device, .best = {}, .rivals = fitted.rivals, .last_change = fitted.last_change};
  found.best = {.numbers = fitted.numbers,
                .x = fitted.x,
                .covariance = fitted.covariance,
                .stiffness_slope = fitted.slope,
                .stiffness = fitted.value,
                .interval = {fitted.lower, fitted.upper},
                .motion = structure.parameters().motion};
  return found;
}

Identification identified_by_lines(const MeasuredResponse& measured, const Device& structure,
                                   const IdentifyOptions& options, std::vector<Finding> doubts = {},
                                   bool motion_tells_none = false) {
  const FrequencyResponse response = band_of(measured.response, options.fit);
  VerdictInput fit = before_fit(measured, structure, std::move(doubts));
  fit.motion_tells_none = motion_tells_none;
  if (!fit.contradictions.empty() || is_drowned(response, structure, options))
    return judged_identification(measured, structure, options, std::nullopt, std::move(fit),
                                 IdentifyOptions::Method::lines);
  const auto fitted = fit_response({.structure = structure,
                                    .response = &response,
                                    .limits = options.limits,
                                    .free = options.fit.free,
                                    .locked = options.fit.locked,
                                    .known = knows_structure(options),
                                    .frees_lateness = frees_lateness(options)});
  std::optional<FoundDevice> found;
  if (fitted) {
    found = found_device(*fitted, structure);
    fit.omnibus = fitted->omnibus;
    fit.records = {{measured.source, response.sampling_period.value_or(0.0)}};
  }
  return judged_identification(measured, structure, options, std::move(found), std::move(fit),
                               IdentifyOptions::Method::lines);
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
  VerdictInput fit = before_fit(measured, structure, doubts);
  const auto unfitted = [&] {
    return judged_identification(measured, structure, options, std::nullopt, std::move(fit),
                                 IdentifyOptions::Method::motion);
  };
  constexpr std::size_t least_lines = 2;  // of which a fit of the motion begins
  const bool drowned = is_drowned(measured.response, structure, options);
  if (!fit.contradictions.empty() || (drowned && measured.response.points.size() < least_lines)) return unfitted();
  const bool is_start = options.fit.start == ParameterFitOptions::Start::from_structure;
  const auto fitted =
      fit_motion(recordings, measured.response, structure,
                 {{options.fit.free, options.fit.locked, frees_lateness(options), is_start, knows_structure(options)},
                  options.segment,
                  options.limits,
                  tell});
  // A spring that stiffens scatters the lines of a motion that is all the force's.
  if (drowned && !(fitted && follows_force(fitted->motions))) return unfitted();
  if (!fitted || !told_limit(fitted->found.best.interval))
    return identified_by_lines(measured, structure, options, std::move(doubts), true);
  fit.omnibus = fitted->omnibus;
  fit.delay = fitted->delay;
  fit.further_body = fitted->further_body;
  fit.force_has_one_size = fitted->force_has_one_size;
  fit.doubts_of_data.insert(fit.doubts_of_data.end(), fitted->contradicted.begin(), fitted->contradicted.end());
  for (const Recording& each : recordings) fit.records.push_back({each.source, each.sampling_period});
  Identification result = judged_identification(measured, structure, options, fitted->found, std::move(fit),
                                                IdentifyOptions::Method::motion);
  result.motions = fitted->motions;
  constexpr double all_but_ends = 0.9;  // rows that no segment begins or ends with are few
  if (fitted->fitted_share < all_but_ends) {
    result.remarks.push_back(
        note({.code = FindingCode::rows_fitted_in_part, .evidence = {{"share", fitted->fitted_share}}}));
  }
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
  require_no_tracking(structure);
  require_open_damper(structure);
  require_valid(find_problem(options));
  require_motion(recordings, structure, options);
  const MeasuredResponse measured = response_with_enough_lines(recordings, structure, options, {});
  if (fit_method(recordings, structure, options) == IdentifyOptions::Method::lines)
    return identified_by_lines(measured, structure, options, doubts_of_recordings(recordings, structure, options));
  return identified_by_motion(recordings, measured, structure, options,
                              doubts_of_recordings(recordings, structure, options), progress);
}

Identification identify(const MeasuredResponse& measured, const Device& structure, const IdentifyOptions& options) {
  require_no_coordinates(structure);
  require_no_tracking(structure);
  require_open_damper(structure);
  require_valid(find_problem(options));
  return identified_by_lines(measured, structure, options);
}

Identification identify_from_limits(const Device& structure, const IdentifyOptions& options) {
  require_no_coordinates(structure);
  require_no_tracking(structure);
  require_one_rate(structure);
  require_valid(find_problem(options));
  if (options.limits.empty()) refuse_member("limits", {.code = ProblemCode::no_values});
  const auto fitted = fit_response({.structure = structure,
                                    .limits = options.limits,
                                    .free = options.fit.free,
                                    .locked = options.fit.locked,
                                    .known = knows_structure(options)});
  std::optional<FoundDevice> found;
  if (fitted) found = found_device(*fitted, structure);
  MeasuredResponse none;
  none.source = "measured limits";
  VerdictInput fit{.motion = structure.parameters().motion};
  if (fitted) fit.omnibus = fitted->omnibus;
  fit.records = {{none.source, 0.0}};
  return judged_identification(none, structure, options, found, std::move(fit), IdentifyOptions::Method::lines);
}

}  // namespace zwidth
