#include "results/identification_json.hpp"

#include <complex>
#include <span>

#include "results/analysis_json.hpp"
#include "results/units.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::results {

void to_json(Json& json, const StiffnessBasis& basis) {
  json = {{"virtual_damping", basis.virtual_damping},
          {"velocity_filter_hz", basis.velocity_filter_hz},
          {"filters", basis.filters}};
}

static void to_json(Json& json, const StrongCorrelation& strong) {
  json = {{"parameters", {strong.first, strong.second}}, {"correlation", strong.correlation}};
}

namespace {

/// {"key", "value", "unit", "identifiable", "standard_deviation", "interval"}; null for what does not exist.
Json estimates_json(std::span<const ParameterEstimate> estimates, Motion motion) {
  Json all = Json::array();
  for (const ParameterEstimate& each : estimates) {
    all.push_back({{"key", each.key},
                   {"value", each.value},
                   {"unit", parameter_unit(each.key, motion)},
                   {"identifiable", each.identifiable},
                   {"standard_deviation", each.standard_deviation},
                   {"interval", each.lower ? Json::array({*each.lower, *each.upper}) : Json(nullptr)}});
  }
  return all;
}

Json pair(const std::complex<double>& value) { return Json::array({value.real(), value.imag()}); }

Json points_json(const ParameterFit& fit) {
  Json frequencies = Json::array();
  Json measured = Json::array();
  Json fitted = Json::array();
  for (std::size_t i = 0; i < fit.frequencies.size(); ++i) {
    frequencies.push_back(hertz(fit.frequencies[i]));
    measured.push_back(pair(fit.fitted[i] + fit.residuals[i]));
    fitted.push_back(pair(fit.fitted[i]));
  }
  return {{"frequency_hz", frequencies}, {"measured", measured}, {"fitted", fitted}};
}

}  // namespace

static void to_json(Json& json, const FittedMotion& motion) {
  json = {{"source", motion.source},
          {"recorded_sampling_period_s", motion.sampling_period},
          {"constant_force", motion.constant_force},
          {"constant_force_deviation", motion.constant_force_deviation},
          {"noise", motion.noise},
          {"unexplained", motion.unexplained}};
}

static void to_json(Json& json, const RivalEstimate& rival) {
  json = {{"code", rival.code},
          {"parameter", rival.parameter},
          {"unit", rival.unit},
          {"value", rival.value},
          {"standard_deviation", rival.standard_deviation},
          {"log_likelihood_gain", rival.log_likelihood_gain},
          {"critical_stiffness_interval", nullptr}};
  if (const auto& range = rival.stiffness_interval) {
    json["critical_stiffness_interval"] = {Json(range->lower), Json(range->upper)};
  }
}

Json identification_json(const Identification& identified, PointsInJson points) {
  const ParameterFit& fit = identified.fit;
  const Json analysis = analysis_json(fit.device, identified.analysis);
  const bool has_response = !fit.frequencies.empty();
  Json json = document("zwidth.identification/1");
  json["method"] = identified.motions.empty() && !has_response            ? "limits"
                   : identified.method == IdentifyOptions::Method::motion ? "time-domain"
                                                                          : "frequency-response";
  json["source"] = identified.source;
  json["recordings"] = identified.motions;
  json["device"] = fit.device.name();
  json["units"] = analysis["units"];
  json["recorded_sampling_period_s"] = identified.response.sampling_period;
  json["band_hz"] =
      has_response ? Json::array({hertz(fit.frequencies.front()), hertz(fit.frequencies.back())}) : Json(nullptr);
  json["point_count"] = fit.frequencies.size();
  json["parameters"] = estimates_json(fit.estimates, fit.device.parameters().motion);
  json["correlations"] = fit.correlations;
  json["unidentifiable"] = Json::array();
  for (const UnidentifiableCombination& each : fit.unidentifiable) json["unidentifiable"].push_back(each.parameters);
  json["misfit"] = fit.misfit;
  json["model_error"] = fit.model_error;
  json["held_to_measured_critical_point"] = false;  // every fit counts all points alike
  json["critical_stiffness_without_hold"] = nullptr;
  json["rivals"] = identified.rivals;
  // The limit, none where it is refused, and how far it is to be trusted.
  if (identified.trust.refused()) {
    for (Json& rival : json["rivals"]) rival["critical_stiffness_interval"] = nullptr;
  }
  for (const char* key : {"status", "critical_stiffness", "critical_stiffness_interval", "critical_frequency_hz",
                          "limited_by", "limits"}) {
    json[key] = identified.trust.refused() ? Json(nullptr) : analysis[key];
  }
  json["modes"] = analysis["modes"];
  json["basis"] = identified.basis;
  add_findings(json, identified);
  if (points == PointsInJson::included) json["points"] = points_json(fit);
  json["device_toml"] = write_device(fit.device.parameters(), identified.remarks);
  return json;
}

Json identification_json(const RigidBodyIdentification& identified) {
  const RigidBodyFit& fit = identified.fit;
  Json json = document("zwidth.inverse_dynamics/1");
  json["source"] = identified.source;
  json["parameters"] = estimates_json(estimates(fit), identified.device.parameters().motion);
  json["relative_residual"] = fit.relative_residual;
  json["cutoff_hz"] = fit.cutoff_hz;
  json["decimation"] = fit.decimation;
  json["equations"] = fit.equations;
  add_findings(json, identified);
  json["device_toml"] = write_device(identified.device.parameters(), identified.remarks);
  return json;
}

std::string identification_csv(const Identification& identified) {
  const ParameterFit& fit = identified.fit;
  Csv csv({"frequency_hz", "real", "imaginary", "fitted_real", "fitted_imaginary", "trust"});
  for (std::size_t i = 0; i < fit.frequencies.size(); ++i) {
    const std::complex<double> measured = fit.fitted[i] + fit.residuals[i];
    csv.row(hertz(fit.frequencies[i]), measured.real(), measured.imag(), fit.fitted[i].real(), fit.fitted[i].imag(),
            identified.trust);
  }
  return csv.text();
}

std::string identification_csv(const RigidBodyIdentification& identified) {
  const RigidBodyFit& fit = identified.fit;
  Csv csv({"time_s", "force", "fitted_force", "trust"});
  for (std::size_t i = 0; i < fit.times.size(); ++i) {
    csv.row(Rounded{fit.times[i], 12}, fit.forces[i], fit.forces[i] - fit.residual_forces[i], identified.trust);
  }
  return csv.text();
}

}  // namespace zwidth::results
