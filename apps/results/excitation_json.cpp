#include "results/excitation_json.hpp"

#include <optional>

#include "results/csv.hpp"
#include "results/units.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(ExcitationKind, {{ExcitationKind::linear_chirp, "linear-chirp"},
                                              {ExcitationKind::logarithmic_chirp, "log-chirp"},
                                              {ExcitationKind::multisine, "multisine"},
                                              {ExcitationKind::noise, "noise"},
                                              {ExcitationKind::relay, "relay"}})

namespace {

Json check_json(const report::CheckedExcitation& checked) {
  if (!checked.check) return nullptr;
  return {{"device", checked.device},
          {"largest_motion", checked.check->peak_stroke},
          {"within_limits", checked.check->exceeded.empty()},
          {"exceeded", checked.check->exceeded},
          {"remarks", checked.check->remarks}};
}

}  // namespace

Json excitation_json(const report::CheckedExcitation& checked) {
  const ExcitationOptions& options = checked.options;
  const Excitation& excitation = checked.excitation;
  const CrestFactor crest = crest_factor(excitation.samples);
  const Units units = units_of(checked.motion);
  std::optional<double> highest;
  if (options.kind != ExcitationKind::relay) highest = options.highest_hz;
  Json json = document("zwidth.excitation/1");
  json["kind"] = options.kind;
  json["units"] = {{"force", units.force}, {"motion", units.length}};
  json["lowest_hz"] = options.lowest_hz;
  json["highest_hz"] = highest;
  json["rate_hz"] = options.rate;
  json["samples"] = excitation.samples.size();
  json["duration_s"] = static_cast<double>(excitation.samples.size()) / options.rate;
  json["period_samples"] = excitation.period > 0 ? Json(excitation.period) : Json(nullptr);
  json["peak_force"] = crest.peak;
  json["rms_force"] = crest.rms;
  json["crest_factor"] = crest.factor;
  json["remarks"] = excitation.remarks;
  json["check"] = check_json(checked);
  return json;
}

void write_excitation_csv(const Excitation& excitation, double rate, Motion motion,
                          const std::function<void(std::string_view)>& sink) {
  Csv csv(sink, {"time_s", motion == Motion::rotary ? "torque_N_m" : "force_N"});
  for (std::size_t k = 0; k < excitation.samples.size(); ++k) {
    csv.row(Shortest{static_cast<double>(k) / rate}, Rounded{excitation.samples[k], 9});
  }
  csv.flush();
}

}  // namespace zwidth::results
