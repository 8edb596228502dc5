#include "results/diagnosis_json.hpp"

#include <numbers>

#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {

static void to_json(Json& json, const OtherwiseNeeded& needed) {
  json = {{"limit", needed.limit}, {"frequency", needed.frequency}, {"amplitude", needed.amplitude}};
}

static void to_json(Json& json, const OscillationCandidate& candidate) {
  const bool has_frequency = candidate.frequency > 0.0;
  json = {{"cause", candidate.cause},
          {"fits", candidate.fits},
          {"frequency_rad_s", has_frequency ? std::optional(candidate.frequency) : std::nullopt},
          {"frequency_hz", has_frequency ? hertz(std::optional(candidate.frequency)) : std::nullopt},
          {"stiffness", candidate.stiffness},
          {"damping", candidate.damping},
          {"amplitude", candidate.amplitude},
          {"limited_by", candidate.limited_by},
          {"why", text(candidate.why)},
          {"otherwise", candidate.otherwise}};
}

static void to_json(Json& json, const DiagnosisChange& change) {
  json = {{"what", words_of(change)},
          {"parameter", change.key},
          {"value_now", change.value_now},
          {"value_then", change.value_then},
          {"damping_then", change.damping_then},
          {"delay_then_s", change.delay_then},
          {"limit_now", change.limit_now},
          {"limit_then", change.limit_then},
          {"amplitude_now", change.amplitude_now},
          {"amplitude_then", change.amplitude_then},
          {"ends_it", change.ends_it},
          {"any_user_then", change.absolute_stability_limit_then},
          {"safe", change.safe}};
}

Json diagnosis_json(const Device& device, const Diagnosis& diagnosis) {
  Json json = document("zwidth.diagnosis/1");
  json["device"] = device.name();
  json["units"] = wall_units(device.parameters().motion);
  json["limits"] = diagnosis.limits;
  json["oscillates_rad_s"] = diagnosis.frequency;
  json["oscillates_hz"] = hertz(diagnosis.frequency);
  json["amplitude"] = diagnosis.amplitude;
  json["stiffness"] = diagnosis.stiffness;
  json["damping"] = diagnosis.damping;
  json["limit_of"] = diagnosis.limit_of == WallNumber::stiffness ? "stiffness" : "damping";
  json["cause"] = diagnosis.cause;
  json["nearest"] = diagnosis.nearest;
  json["any_user_now"] = diagnosis.absolute_stability_limit_now;
  json["candidates"] = diagnosis.candidates;
  json["changes"] = diagnosis.changes;
  add_findings(json, diagnosis);
  return json;
}

}  // namespace zwidth::results
