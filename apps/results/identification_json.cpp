#include "results/identification_json.hpp"

#include <cmath>
#include <complex>

#include "report/text/quantity.hpp"
#include "results/analysis_json.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

Json number_or_null(std::optional<double> value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json points_json(const IdentifiedDevice& identified) {
  Json frequencies = Json::array();
  Json measured = Json::array();
  Json fitted = Json::array();
  const ParameterFit& fit = identified.fit;
  for (std::size_t i = 0; i < fit.frequencies.size(); ++i) {
    const std::complex<double> value = fit.fitted[i] + fit.residuals[i];
    frequencies.push_back(hertz(fit.frequencies[i]));
    measured.push_back({value.real(), value.imag()});
    fitted.push_back({fit.fitted[i].real(), fit.fitted[i].imag()});
  }
  return {{"frequency_hz", frequencies}, {"measured", measured}, {"fitted", fitted}};
}

}  // namespace

results::Json estimate_json(const ParameterEstimate& estimate, Motion motion) {
  const Json interval = estimate.lower ? Json::array({*estimate.lower, *estimate.upper}) : Json(nullptr);
  return {{"key", estimate.key},
          {"value", estimate.value},
          {"unit", unit_of_parameter(estimate.key, motion)},
          {"identifiable", estimate.identifiable},
          {"standard_deviation", number_or_null(estimate.standard_deviation)},
          {"interval", interval}};
}

results::Json identification_json(const IdentifiedDevice& identified, PointsInJson points) {
  const ParameterFit& fit = identified.fit;
  const Motion motion = fit.device.parameters().motion;
  const Json analysis = results::analysis_json(identified.analysed.device, identified.analysed.analysis);
  Json document;
  document["schema"] = "zwidth.identification/1";
  document["source"] = identified.source;
  document["device"] = fit.device.name();
  document["units"] = analysis["units"];
  document["recorded_sampling_period_s"] = number_or_null(identified.response.sampling_period);
  document["band_hz"] = {hertz(fit.frequencies.front()), hertz(fit.frequencies.back())};
  document["point_count"] = fit.frequencies.size();
  document["parameters"] = Json::array();
  for (const ParameterEstimate& estimate : fit.estimates)
    document["parameters"].push_back(estimate_json(estimate, motion));
  document["correlations"] = Json::array();
  for (const StrongCorrelation& each : fit.correlations) {
    document["correlations"].push_back({{"parameters", {each.first, each.second}}, {"correlation", each.correlation}});
  }
  document["unidentifiable"] = Json::array();
  for (const UnidentifiableCombination& each : fit.unidentifiable) {
    document["unidentifiable"].push_back(each.parameters);
  }
  document["misfit"] = number_or_null(fit.misfit);
  document["model_error"] = fit.model_error;
  document["held_to_measured_critical_point"] = fit.stiffness_without_hold.has_value();
  document["critical_stiffness_without_hold"] = number_or_null(fit.stiffness_without_hold);
  for (const char* key : {"status", "critical_stiffness", "critical_stiffness_interval", "critical_frequency_hz",
                          "limited_by", "modes"}) {
    document[key] = analysis[key];
  }
  if (identified.trust.refused()) {
    for (const char* key :
         {"status", "critical_stiffness", "critical_stiffness_interval", "critical_frequency_hz", "limited_by"}) {
      document[key] = nullptr;
    }
  }
  document["basis"] = {{"virtual_damping", identified.basis.virtual_damping},
                       {"velocity_filter_hz", identified.basis.velocity_filter_hz},
                       {"filters", identified.basis.filters}};
  document["trust"] = identified.trust;
  document["remarks"] = identified.remarks;
  if (points == PointsInJson::included) document["points"] = points_json(identified);
  return document;
}

}  // namespace zwidth::report
