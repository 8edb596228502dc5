#include "results/rig_json.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "results/excitation_json.hpp"
#include "results/frf_json.hpp"
#include "results/identification_json.hpp"
#include "results/relay_json.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"

namespace zwidth::results {

static void to_json(Json& json, const LatencySummary& summary) {
  if (summary.count == 0) {
    json = nullptr;
    return;
  }
  json = {{"count", summary.count}, {"p50", summary.p50},      {"p99", summary.p99},
          {"p99_9", summary.p999},  {"p99_99", summary.p9999}, {"max", summary.max}};
}

static void to_json(Json& json, const RingDown& ring) {
  json = {{"frequency_rad_s", ring.frequency},
          {"frequency_hz", hertz(ring.frequency)},
          {"growth_rate_per_s", ring.growth_rate},
          {"growth_deviation_per_s", ring.growth_deviation},
          {"amplitude", ring.amplitude}};
}

static void to_json(Json& json, const Nudge& nudge) {
  json = {{"force", nudge.force}, {"moved", nudge.moved}, {"reading", nudge.reading}};
}

static void to_json(Json& json, const LimitTrial& trial) {
  json = {{"stiffness", trial.stiffness},
          {"grows", trial.grows()},
          {"stopped", trial.stopped},
          {"growth_error_per_s", trial.ring ? Json(trial.growth_error) : Json(nullptr)},
          {"oscillation", trial.ring}};
}

static void to_json(Json& json, const DriveSettings& drive) {
  json = {{"firmware", drive.firmware.empty() ? Json(nullptr) : Json(drive.firmware)},
          {"least_force", drive.least_force},
          {"tracking_bandwidth_rad_s", drive.tracking_bandwidth},
          {"position_lag_s", drive.position_lag},
          {"mode_after_watchdog", drive.mode_after_watchdog}};
}

namespace {

Json session_json(const RigSession& session) {
  const SafetyLimits& limits = session.limits;
  const LoopTiming& timing = session.timing;
  return {{"driver", session.driver},
          {"lock_step", session.lock_step},
          {"sampling_period_s", session.sampling_period},
          {"stop", session.stop},
          {"stopped_at_s", session.stop == StopReason::none ? Json(nullptr) : Json(session.stopped_at)},
          {"nudge", session.nudge},
          {"drive_force_limit", session.drive.force_limit},
          {"drive", session.drive},
          {"limits",
           {{"force", limits.force},
            {"position", limits.position},
            {"velocity", limits.velocity},
            {"saturation_s", limits.saturation_duration},
            {"missed_cycles", limits.missed_cycles},
            {"ramp_s", limits.ramp}}},
          {"firmware_watchdog_s", session.firmware_watchdog},
          {"timing",
           {{"cycles", timing.cycles},
            {"missed", timing.missed},
            {"unanswered", timing.unanswered},
            {"latency_s", timing.latency},
            {"period_s", timing.period},
            {"body_s", timing.body},
            {"delay_s", timing.delay}}},
          {"remarks", session.remarks}};
}

Json begun(const char* action, const Device& device, const RigSession& session) {
  const Units units = units_of(device.parameters().motion);
  Json json = document(fmt::format("zwidth.rig_{}/1", action));
  json["device"] = device.name();
  json["units"] = {
      {"stiffness", units.stiffness}, {"damping", units.damping}, {"force", units.force}, {"length", units.length}};
  json["session"] = session_json(session);
  return json;
}

std::vector<Remark> together(std::vector<Remark> first, const std::vector<Remark>& then) {
  first.insert(first.end(), then.begin(), then.end());
  return first;
}

Json predicted_json(const CriticalStiffness& predicted) {
  Json json = Json::object();
  add_critical(json, predicted);
  json["trust"] = predicted.trust;
  json["findings"] = findings_json(predicted.trust);
  return json;
}

void add_measurement(Json& json, const Device& device, const RigMeasurement& measurement) {
  json["excitation"] = excitation_json(measurement.excitation);
  json["frf"] = measurement.response ? frf_json(*measurement.response, frf_units(device)) : Json(nullptr);
}

}  // namespace

Json rig_json(const Device& device, const RigCheck& check) {
  Json json = begun("check", device, check.session);
  json["watchdog_proved"] = check.watchdog_proved;
  const LoopTiming& timing = check.session.timing;
  const bool has_clock = timing.delay.count > 0;
  const bool has_delay = has_clock && check.session.driver != "simulated";  // whose delay is its file's
  json["measured_delay_s"] = has_delay ? Json(timing.delay.p50) : Json(nullptr);
  json["measured_jitter_s"] = has_clock ? Json(timing.latency.p99) : Json(nullptr);
  json["trust"] = check.trust;
  json["findings"] = findings_json(check.trust, check.session.remarks);
  return json;
}

Json rig_json(const Device& device, const RigMeasurement& measurement) {
  Json json = begun("measure", device, measurement.session);
  add_measurement(json, device, measurement);
  json["trust"] = measurement.trust;
  json["findings"] = findings_json(measurement.trust, measurement.session.remarks);
  return json;
}

Json rig_json(const Device& device, const RigIdentification& identification) {
  Json json = begun("identify", device, identification.measurement.session);
  add_measurement(json, device, identification.measurement);
  json["identification"] =
      identification.identification ? identification_json(*identification.identification) : Json(nullptr);
  json["trust"] = identification.trust;
  json["findings"] = findings_json(identification.trust, identification.measurement.session.remarks);
  return json;
}

Json rig_json(const Device& device, const RigRelay& relay) {
  Json json = begun("relay", device, relay.session);
  json["relay"] = relay.relay ? relay_json(*relay.relay) : Json(nullptr);
  const bool has_row = relay.relay && relay.relay->mean;
  json["table_2_row"] = nullptr;
  if (has_row) {
    const RelayMean& mean = *relay.relay->mean;
    json["table_2_row"] = {{"delay_s", device.loop().delay},
                           {"frequency_hz", hertz(mean.frequency)},
                           {"stiffness_db", decibels(std::optional(mean.stiffness))},
                           {"trials", mean.trials}};
  }
  json["trust"] = relay.trust;
  json["findings"] = findings_json(relay.trust, relay.session.remarks);
  return json;
}

Json rig_json(const Device& device, const RigWall& wall) {
  Json json = begun("wall", device, wall.session);
  json["wall"] = {{"stiffness", wall.controller.stiffness},
                  {"damping", wall.controller.damping},
                  {"velocity_filter_hz", wall.controller.velocity_filter_hz},
                  {"filters", wall.controller.filters.size()},
                  {"damper_on_drive", wall.damper_on_drive}};
  json["predicted"] = predicted_json(wall.predicted);
  json["limits"] = wall.limits;
  json["stable_for"] = wall.stable_for;
  json["predicted_stable"] = wall.predicted_stable;
  json["oscillates"] = wall.oscillates;
  json["oscillation"] = wall.ring;
  json["peak_force"] = wall.peak_force;
  json["peak_position"] = wall.peak_position;
  json["trust"] = wall.trust;
  json["findings"] = findings_json(wall.trust, wall.session.remarks);
  return json;
}

Json rig_json(const Device& device, const RigLimit& limit) {
  Json json = begun("limit", device, limit.session);
  const LimitMeasurement& measured = limit.measured;
  const bool has_frequency = measured.stiffness && measured.frequency > 0.0;
  json["measured"] = {{"critical_stiffness", measured.stiffness},
                      {"critical_stiffness_db", decibels(measured.stiffness)},
                      {"critical_stiffness_interval", measured.interval},
                      {"frequency_rad_s", has_frequency ? Json(measured.frequency) : Json(nullptr)},
                      {"frequency_hz", has_frequency ? Json(hertz(measured.frequency)) : Json(nullptr)},
                      {"stiffest_stable", measured.lower > 0.0 ? Json(measured.lower) : Json(nullptr)},
                      {"softest_unstable", measured.upper > 0.0 ? Json(measured.upper) : Json(nullptr)}};
  json["predicted"] = predicted_json(limit.predicted);
  json["limits"] = limit.limits;
  json["any_user"] = nullptr;
  if (limit.any_user) {
    json["any_user"] = {{"critical_stiffness", limit.any_user->stiffness},
                        {"frequency_rad_s", limit.any_user->frequency}};
  }
  json["measured_over_predicted"] = nullptr;
  if (measured.stiffness && limit.predicted.status == StiffnessStatus::finite) {
    json["measured_over_predicted"] = *measured.stiffness / limit.predicted.stiffness;
  }
  json["knock"] = limit.impulse;
  json["trials"] = measured.trials;
  json["trust"] = limit.trust;
  json["remarks"] = limit.remarks;
  json["findings"] = findings_json(limit.trust, together(limit.session.remarks, limit.remarks));
  return json;
}

}  // namespace zwidth::results
