#include "identification/judged_identification.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "identification/device_file_trust.hpp"
#include "identification/fit_method.hpp"
#include "identification/limit_of_response.hpp"
#include "identification/response_of_device.hpp"
#include "identification/verdict/assumed_experiment.hpp"
#include "identification/verdict/plausible_device.hpp"
#include "identification/verdict/widening.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

/// The remarks, less those of the limit that the response alone shows, which a fit does not ask; a fit of the motion has the
/// friction too that makes responses differ.
std::vector<Remark> remarks_of_fit(const MeasuredResponse& measured, IdentifyOptions::Method method) {
  constexpr std::array of_response_alone{FindingCode::friction_unknown, FindingCode::one_amplitude,
                                         FindingCode::table_hides_friction};
  std::vector<Remark> remarks = measured.remarks;
  std::erase_if(remarks, [&](const Remark& remark) {
    if (!remark.finding) return false;
    const FindingCode code = remark.finding->code;
    if (std::ranges::find(of_response_alone, code) != of_response_alone.end()) return true;
    if (method == IdentifyOptions::Method::motion && code == FindingCode::response_depends_as_by_friction) return true;
    const auto is_it = [&](const Remark& other) { return other.finding == remark.finding; };
    return measured.stiffness && std::ranges::any_of(measured.stiffness->remarks, is_it);
  });
  return remarks;
}

ParameterEstimate undetermined_estimate(const std::string& key, const Device& structure) {
  ParameterEstimate estimate;
  estimate.key = key;
  estimate.value = parameter(structure.parameters(), key).value_or(0.0);
  estimate.identifiable = false;
  return estimate;
}

/// What was found, in the answer and before the judge. `is_known`: the structure's numbers are the device's.
void take_found(const FoundDevice& found, const Device& structure, bool is_known, Identification& result,
                VerdictInput& fit) {
  result.fit = {.device = device_of(found),
                .estimates = estimates_of(found),
                .correlations = correlations_of(found),
                .unidentifiable = open_numbers_of(found),
                .misfit = {},
                .settled = found.last_change == 0.0};
  result.rivals = rival_table(found.best, found.rivals);
  fit.rivals = result.rivals;
  fit.last_change = found.last_change;
  if (auto doubt = doubt_of_masses(result.fit.device, structure, is_known))
    fit.doubts_of_data.push_back(*std::move(doubt));
  std::ranges::move(
      implausible_device(result.fit.device, is_known ? &structure : nullptr, result.response.sampling_period),
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
                       knows_structure(options) ? std::vector<std::string>{} : unseen_placeholders(options.fit.locked),
                       result.fit.device, result.trust);
  result.fit.device = with_trust(result.fit.device, result.trust);
  if (result.trust.refused()) result.analysis = analyze(result.fit.device, {.any_user = false});
  result.analysis.trust.inherit(result.trust);
}

}  // namespace

Identification judged_identification(const MeasuredResponse& measured, const Device& structure,
                                     const IdentifyOptions& options, std::optional<FoundDevice> found, VerdictInput fit,
                                     IdentifyOptions::Method method) {
  Identification result{.source = measured.source,
                        .method = method,
                        .response = measured.response,
                        .fit = {.device = structure, .misfit = {}}};
  result.remarks = remarks_of_fit(measured, method);
  if (found) {
    Interval& interval = found->best.interval;
    fit.limit = told_limit(interval);
    if (!is_explained(fit))
      interval = with_limit_of_response(interval, measured.response, structure, options.fit.locked);
    take_found(*found, structure, knows_structure(options), result, fit);
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
  std::ranges::move(assumptions_of_experiment(structure, knows_structure(options), options.fit.locked),
                    std::back_inserter(result.remarks));
  const Wall& wall = result.fit.device.parameters().wall;
  result.basis = {wall.damping, wall.velocity_filter_hz, wall.filters.size()};
  if (found) take_interval(found->best.interval, result);
  spread_trust(structure, options, result);
  if (fit.further_body) result.fit.device = with_reason(result.fit.device, *fit.further_body);
  return result;
}

}  // namespace zwidth::internal
