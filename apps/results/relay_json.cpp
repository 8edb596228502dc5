#include "results/relay_json.hpp"

#include <fmt/format.h>

#include <optional>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {

static void to_json(Json& json, const LimitCycle& cycle) {
  json = {{"frequency_rad_s", cycle.frequency},
          {"frequency_hz", hertz(cycle.frequency)},
          {"stiffness", cycle.stiffness},
          {"stiffness_db", decibels(std::optional(cycle.stiffness))},
          {"amplitude", cycle.amplitude}};
}

static void to_json(Json& json, const RelayMean& mean) {
  json = {{"trials", mean.trials},
          {"frequency_rad_s", mean.frequency},
          {"frequency_hz", hertz(mean.frequency)},
          {"stiffness", mean.stiffness},
          {"stiffness_db", decibels(std::optional(mean.stiffness))},
          {"amplitude", mean.amplitude}};
}

static void to_json(Json& json, const RelayPrediction& prediction) {
  json = {{"critical", prediction.linear.limit},
          {"crossovers", prediction.linear.crossovers},
          {"describing_function", prediction.describing_function},
          {"exact_searched_above_rad_s", prediction.lowest_frequency},
          {"sampled_relay", prediction.sampled_relay},
          {"continuous_relay", prediction.continuous_relay}};
}

namespace {

Json reading_json(const RelayReading& reading, double period) {
  return {{"frequency_rad_s", reading.frequency},
          {"frequency_hz", hertz(reading.frequency)},
          {"cycle_frequency_hz", hertz(reading.cycle_frequency)},
          {"line_spacing_hz", hertz(reading.line_spacing)},
          {"stiffness", reading.stiffness},
          {"stiffness_db", decibels(std::optional(reading.stiffness))},
          {"amplitude", reading.amplitude},
          {"scatter", reading.scatter},
          {"steady_from_s", static_cast<double>(reading.steady_from) * period},
          {"steady_samples", reading.steady_samples},
          {"segments", reading.segments}};
}

Json trial_json(const RelayTrial& trial, const RelayResult& result) {
  const bool is_simulated = result.source == RelayResult::Source::simulation;
  const auto& reading = trial.result;
  return {{"oscillates", reading.has_value()},
          {"reason", reading ? Json(nullptr) : Json(text(reading.error().why))},
          {"start_offset", is_simulated ? Json(trial.start_offset) : Json(nullptr)},
          {"friction_factor", is_simulated ? Json(trial.friction_factor) : Json(nullptr)},
          {"result", reading ? reading_json(*reading, result.sampling_period) : Json(nullptr)},
          {"remarks", reading ? Json(reading->remarks) : Json::array()}};
}

}  // namespace

Json relay_json(const RelayResult& result) {
  const Units units = units_of(result.motion);
  const bool is_simulated = result.source == RelayResult::Source::simulation;
  Json json = document("zwidth.relay/1");
  json["source"] = result.source;
  json["recording"] = is_simulated ? Json(nullptr) : Json(result.recording);
  json["device"] = result.device ? Json(result.device->name()) : Json(nullptr);
  json["units"] = {{"stiffness", units.stiffness}, {"force", units.force}, {"length", units.length}};
  json["sampling_period_s"] = result.sampling_period;
  json["delay_s"] = result.device ? Json(result.device->loop().delay) : Json(nullptr);
  json["relay"] = {{"amplitude", result.relay.amplitude},
                   {"hysteresis", is_simulated ? Json(result.relay.hysteresis) : Json(nullptr)}};
  json["friction_level"] = result.friction_level;
  json["trials"] = Json::array();
  for (const RelayTrial& trial : result.trials) json["trials"].push_back(trial_json(trial, result));
  json["mean"] = result.mean;
  json["predictions"] = result.prediction;
  json["explanation"] = Json::array();
  for (const Finding& each : result.explanation) json["explanation"].push_back(text(each));
  json["limit_reading"] = result.limit_reading;
  add_findings(json, result);
  return json;
}

std::string relay_csv(const RelayResult& result) {
  Csv rows;
  rows.cell("time_s");
  for (std::size_t i = 1; i <= result.trials.size(); ++i) {
    rows.cell(fmt::format("force_{}", i));
    rows.cell(fmt::format("position_{}", i));
  }
  rows.cell("trust");
  rows.end_row();
  const std::size_t samples = result.trials.empty() ? 0 : result.trials.front().force.size();
  for (std::size_t k = 0; k < samples; ++k) {
    rows.cell(Rounded{static_cast<double>(k) * result.sampling_period, 12});
    for (const RelayTrial& trial : result.trials) {
      rows.cell(trial.force[k]);
      rows.cell(trial.position[k]);
    }
    rows.cell(result.trust);
    rows.end_row();
  }
  return rows.text();
}

}  // namespace zwidth::results
