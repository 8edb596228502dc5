#include "results/excitation_json.hpp"

#include <optional>

#include "results/csv.hpp"
#include "results/units.hpp"

namespace zwidth::results {

static void to_json(Json& json, const ExcitationCheck& check) {
  json = {{"device", check.device},
          {"largest_motion", check.peak_stroke},
          {"within_limits", check.exceeded.empty()},
          {"exceeded", check.exceeded},
          {"remarks", check.remarks}};
}

Json excitation_json(const Excitation& excitation) {
  const ExcitationOptions& options = excitation.options;
  const CrestFactor& crest = excitation.crest;
  const Units units = units_of(excitation.motion);
  std::optional<double> highest;
  if (options.kind != ExcitationKind::relay) highest = options.highest_hz;
  Json json = document("zwidth.excitation/1");
  json["kind"] = options.kind;
  json["units"] = {{"force", units.force}, {"motion", units.length}};
  json["lowest_hz"] = options.lowest_hz;
  json["highest_hz"] = highest;
  json["rate_hz"] = excitation.rate;
  json["samples"] = excitation.samples.size();
  json["duration_s"] = static_cast<double>(excitation.samples.size()) / excitation.rate;
  json["period_samples"] = excitation.period > 0 ? Json(excitation.period) : Json(nullptr);
  json["peak_force"] = crest.peak;
  json["rms_force"] = crest.rms;
  json["crest_factor"] = crest.factor;
  json["remarks"] = excitation.remarks;
  json["findings"] = findings_json({}, excitation.remarks);
  json["check"] = excitation.check;
  return json;
}

void write_excitation_csv(const Excitation& excitation, const std::function<void(std::string_view)>& sink) {
  Csv csv(sink, {"time_s", excitation.motion == Motion::rotary ? "torque_N_m" : "force_N"});
  for (std::size_t k = 0; k < excitation.samples.size(); ++k) {
    csv.row(Shortest{static_cast<double>(k) / excitation.rate}, Rounded{excitation.samples[k], 9});
  }
  csv.flush();
}

}  // namespace zwidth::results
