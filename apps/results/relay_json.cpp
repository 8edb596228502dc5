#include "results/relay_json.hpp"

#include "report/text/quantity.hpp"
#include "report/text/relay_explanation.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

Json to_json(const LimitCycle& cycle) {
  return {{"frequency_rad_s", cycle.frequency},
          {"frequency_hz", hertz(cycle.frequency)},
          {"stiffness", cycle.stiffness},
          {"stiffness_db", decibels(cycle.stiffness)},
          {"amplitude", cycle.amplitude}};
}

Json to_json(const Crossover& crossover) {
  const bool is_rigid = crossover.limited_by.kind == Mechanism::Kind::rigid_body;
  Json limited_by = {{"kind", is_rigid ? "rigid_body" : "vibration_mode"}};
  if (!is_rigid) limited_by["mode"] = crossover.limited_by.mode;
  return {{"frequency_rad_s", crossover.frequency},
          {"frequency_hz", hertz(crossover.frequency)},
          {"stiffness", crossover.stiffness},
          {"stiffness_db", decibels(crossover.stiffness)},
          {"limited_by", std::move(limited_by)}};
}

template <typename T>
Json to_json_array(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

Json to_json(const RelayResult& result, double period) {
  return {{"frequency_rad_s", result.frequency},
          {"frequency_hz", hertz(result.frequency)},
          {"cycle_frequency_hz", result.cycle_frequency ? Json(hertz(*result.cycle_frequency)) : Json(nullptr)},
          {"line_spacing_hz", hertz(result.line_spacing)},
          {"stiffness", result.stiffness},
          {"stiffness_db", decibels(result.stiffness)},
          {"amplitude", result.amplitude},
          {"scatter", result.scatter},
          {"steady_from_s", static_cast<double>(result.steady_from) * period},
          {"steady_samples", result.steady_samples},
          {"segments", result.segments}};
}

Json trials_json(const RelayReport& report) {
  Json trials = Json::array();
  for (const RelayTrial& trial : report.trials) {
    Json each;
    each["oscillates"] = trial.result.has_value();
    each["reason"] = trial.result ? Json(nullptr) : Json(trial.result.error().reason);
    const bool is_simulated = report.source == RelayReport::Source::simulation;
    each["start_offset"] = is_simulated ? Json(trial.start_offset) : Json(nullptr);
    each["friction_factor"] = is_simulated ? Json(trial.friction_factor) : Json(nullptr);
    each["result"] = trial.result ? to_json(*trial.result, report.sampling_period) : Json(nullptr);
    each["remarks"] = trial.result ? Json(trial.result->remarks) : Json::array();
    trials.push_back(std::move(each));
  }
  return trials;
}

Json mean_json(const RelayReport& report) {
  const auto mean = mean_of(report.trials);
  if (!mean) return nullptr;
  return {{"trials", mean->trials},
          {"frequency_rad_s", mean->frequency},
          {"frequency_hz", hertz(mean->frequency)},
          {"stiffness", mean->stiffness},
          {"stiffness_db", decibels(mean->stiffness)},
          {"amplitude", mean->amplitude}};
}

Json prediction_json(const RelayReport& report) {
  if (!report.prediction) return nullptr;
  const RelayPrediction& prediction = *report.prediction;
  const auto& limit = prediction.linear.limit;
  return {{"critical", limit ? to_json(*limit) : Json(nullptr)},
          {"crossovers", to_json_array(prediction.linear.crossovers)},
          {"describing_function", to_json_array(prediction.describing_function)},
          {"exact_searched_above_rad_s", prediction.lowest_frequency},
          {"sampled_relay", to_json_array(prediction.sampled_relay)},
          {"continuous_relay", to_json_array(prediction.continuous_relay)}};
}

}  // namespace

results::Json relay_json(const RelayReport& report) {
  const Units units = units_of(report.motion);
  const bool is_simulated = report.source == RelayReport::Source::simulation;
  Json document;
  document["schema"] = "zwidth.relay/1";
  document["source"] = is_simulated ? "simulation" : "recording";
  document["recording"] = is_simulated ? Json(nullptr) : Json(report.recording);
  document["device"] = report.device ? Json(report.device->name()) : Json(nullptr);
  document["units"] = {{"stiffness", units.stiffness}, {"force", units.force}, {"length", units.length}};
  document["sampling_period_s"] = report.sampling_period;
  document["delay_s"] = report.device ? Json(report.device->loop().delay) : Json(nullptr);
  document["relay"] = {{"amplitude", report.relay.amplitude},
                       {"hysteresis", is_simulated ? Json(report.relay.hysteresis) : Json(nullptr)}};
  document["friction_level"] = report.device ? Json(friction_level(report)) : Json(nullptr);
  document["trials"] = trials_json(report);
  document["mean"] = mean_json(report);
  document["predictions"] = prediction_json(report);
  document["explanation"] = relay_explanation(report);
  document["remarks"] = remarks_of(report);
  return document;
}

}  // namespace zwidth::report
