#include "identification/recording_agreement.hpp"

#include <algorithm>
#include <utility>

#include "identification/response/pooled_response.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/record_fit.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {
namespace {

/// What a recording alone says of the critical stiffness.
struct OwnStiffness {
  std::string source;
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

std::optional<OwnStiffness> own_stiffness(const OwnDevice& own) {
  const Analysis analysis = analyze(own.device, {.any_user = false});
  const auto& interval = analysis.interval;
  if (!interval || analysis.critical.trust.refused()) return std::nullopt;
  constexpr double wider = 1.25;  // of several looks
  const double value = analysis.critical.stiffness;
  return OwnStiffness{own.source, value, value - wider * (value - interval->lower),
                      value + wider * (interval->upper - value)};
}

}  // namespace

std::optional<Finding> doubt_of_agreement(const std::vector<OwnDevice>& devices, const Device& pooled) {
  std::vector<OwnStiffness> all;
  for (const OwnDevice& each : devices) {
    if (auto own = own_stiffness(each)) all.push_back(*std::move(own));
  }
  if (all.size() < 2) return std::nullopt;
  const OwnStiffness& softest = *std::ranges::min_element(all, {}, &OwnStiffness::upper);
  const OwnStiffness& stiffest = *std::ranges::max_element(all, {}, &OwnStiffness::lower);
  const double own = limit_of(pooled).stiffness;
  if (stiffest.lower <= softest.upper || own < softest.value || own > stiffest.value) return std::nullopt;
  const std::string_view unit = units_of(pooled.parameters().motion).stiffness;
  return Finding{.code = FindingCode::recordings_disagree,
                 .evidence = {{"softest", softest.value, unit}, {"stiffest", stiffest.value, unit}},
                 .subjects = {{"of_softest", softest.source}, {"of_stiffest", stiffest.source}},
                 .effect = {{"critical_stiffness", softest.value}}};
}

void judge_agreement(Identification& result, std::span<const Recording> recordings, const IdentifyOptions& options) {
  if (recordings.size() < 2 || !result.trust.sound()) return;
  ParameterFitOptions alone = options.fit;
  alone.free.clear();
  for (const ParameterEstimate& each : result.fit.estimates) alone.free.push_back(each.key);
  alone.start = ParameterFitOptions::Start::from_structure;
  alone.search_widely = false;
  alone.critical_point = ParameterFitOptions::CriticalPoint::free;
  std::vector<OwnDevice> devices;
  const std::vector<FrequencyResponse> each = responses(recordings, options.response);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    if (each[r].points.size() <= alone.free.size()) continue;  // a single sine says nothing alone
    try {
      RecordFit fit{fit_parameters(result.fit.device, each[r], alone), each[r]};
      fit = without_leakage(std::move(fit), recordings.subspan(r, 1), options.response, alone);
      devices.push_back({recordings[r].source, std::move(fit.fit.device)});
    } catch (const Error&) {  // nor does what fits no device
      continue;
    }
  }
  const std::optional<Finding> doubt = doubt_of_agreement(devices, result.fit.device);
  if (doubt) result.trust.doubt(*doubt);
}

void judge_measured(const MeasuredResponse& measured, Judgement& judgement) {
  if (measured.dependence && !measured.trust.sound()) {
    judgement.trust.doubt({.code = FindingCode::recordings_averaged});
  }
  if (measured.response.trust && !measured.response.trust->sound()) {
    for (const std::string& reason : measured.trust.reasons) {
      judgement.trust.doubt({.code = FindingCode::table_doubts_itself, .subjects = {{"reason", reason}}});
    }
  }
  judgement.device_trust.inherit(judgement.trust);
}

}  // namespace zwidth::internal
