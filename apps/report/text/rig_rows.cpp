#include "report/text/rig_rows.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string_view>

#include "report/text/holder_limit_text.hpp"
#include "report/text/quantity.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::report {
namespace {

using Rows = std::vector<LabelledText>;

void add_latency(TextTable& table, const std::string& name, const LatencySummary& summary) {
  if (summary.count == 0) return;
  const auto text = [](double value) { return quantity(value, "s"); };
  table.rows.push_back(
      {name, text(summary.p50), text(summary.p99), text(summary.p999), text(summary.p9999), text(summary.max)});
}

std::string predicted_text(const HolderLimit& limit, const Units& units) {
  const std::string text = holder_limit_text(limit, units.stiffness);
  return limit.frequency ? fmt::format("{} at {}", text, crossover_frequency_text(*limit.frequency)) : text;
}

/// What the file predicts, a row for each holder.
void add_predicted(Rows& rows, const HoldingLimits& limits, const Units& units) {
  rows.push_back(
      {"K_CR predicted", fmt::format("{}: {}", words_of(Holder::nobody), predicted_text(limits.nobody, units))});
  const auto add = [&](Holder holder, const std::optional<HolderLimit>& limit) {
    if (limit) rows.push_back({"", fmt::format("{}: {}", words_of(holder), predicted_text(*limit, units))});
  };
  add(Holder::user, limits.user);
  add(Holder::any_user, limits.any_user);
}

std::string nudge_text(const Nudge& nudge, const Units& units) {
  if (nudge.reading == NudgeReading::not_told) {
    return fmt::format("NOT TOLD: the device hardly moved under {}", quantity(nudge.force, units.force));
  }
  const bool is_right = nudge.reading == NudgeReading::with_force;
  return fmt::format("{}: {} of force moved the position by {}{}", is_right ? "right" : "WRONG",
                     quantity(nudge.force, units.force), nudge.moved > 0.0 ? "+" : "",
                     quantity(nudge.moved, units.length));
}

/// Of the drive, and how a file says it; empty where the drive does not tell.
std::string filter_text(const DriveSettings& drive) {
  const double bandwidth = drive.tracking_bandwidth.value_or(0.0);
  if (bandwidth > 0.0) {
    return fmt::format("the drive's, {}; in the file: [sensor] tracking_bandwidth = {:.4g}{}",
                       quantity(bandwidth, "rad/s"), bandwidth,
                       drive.is_filter_assumed ? ", its firmware's default: it does not tell" : "");
  }
  const double lag = drive.position_lag.value_or(0.0);
  if (lag > 0.0) {
    return fmt::format("the drive's, {}; in the file: [actuator] time_constant = {:.3g}", quantity(lag, "s"), lag);
  }
  return drive.tracking_bandwidth || drive.position_lag ? "none" : "";
}

/// What identify takes it as, whose walls are of one rate.
std::string limit_option(const LimitMeasurement& measured, const Device& device) {
  const double damping = device.parameters().wall.damping;
  return fmt::format("--limit \"K={:.4g}{}{}\"", *measured.stiffness,
                     damping > 0.0 ? fmt::format(", B={:.4g}", damping) : "",
                     measured.frequency > 0.0 ? fmt::format(", hz={:.4g}", hertz(measured.frequency)) : "");
}

}  // namespace

Rows stopped_rows(const RigSession& session) {
  if (session.stop == StopReason::none) return {};
  return {{"STOPPED", fmt::format("after {}: {}", quantity(session.stopped_at, "s"), explanation(session))}};
}

Rows session_rows(const RigSession& session) {
  const LoopTiming& timing = session.timing;
  Rows rows{{"driver", session.driver + (session.lock_step ? ", in lock step: its time moves with the cycles" : "")}};
  if (!session.drive.firmware.empty()) rows.push_back({"firmware", session.drive.firmware});
  rows.push_back({"cycles", fmt::format("{} of {}, {} missed, {} without a position", timing.cycles,
                                        quantity(session.sampling_period, "s"), timing.missed, timing.unanswered)});
  return rows;
}

Rows safety_rows(const RigSession& session) {
  const SafetyLimits& limits = session.limits;
  const Units units = units_of(session.motion);
  const auto limit = [](const std::optional<double>& value, const std::string& unit) {
    return value ? quantity(*value, unit) : std::string("none");
  };
  Rows rows{{"force limit", limit(limits.force, std::string(units.force))},
            {"position limit", limit(limits.position, std::string(units.length))},
            {"velocity limit", limit(limits.velocity, fmt::format("{}/s", units.length))},
            {"force cut off for", quantity(limits.saturation_duration, "s") + " at most"}};
  if (limits.missed_cycles)
    rows.push_back({"missed cycles", fmt::format("{} in a row at most", *limits.missed_cycles)});
  rows.push_back({"drive's watchdog", limit(session.firmware_watchdog, "s")});
  return rows;
}

TextTable latency_table(const LoopTiming& timing) {
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::right, Align::right},
                  {{"", "p50", "p99", "p99.9", "p99.99", "largest"}}};
  add_latency(table, "latency", timing.latency);
  add_latency(table, "period", timing.period);
  add_latency(table, "cycle", timing.body);
  return table;
}

TextTable trial_table(const LimitMeasurement& measured, const Units& units) {
  TextTable table{{Align::right, Align::right, Align::right, Align::left}, {{"K", "Hz", "grows by (1/s)", ""}}};
  for (const LimitTrial& trial : measured.trials) {
    table.rows.push_back({quantity(trial.stiffness, units.stiffness),
                          trial.ring ? number(hertz(trial.ring->frequency)) : "-",
                          trial.ring ? number(trial.ring->growth_rate) : "-",
                          trial.stopped                          ? "grew: taken away at once"
                          : trial.cut                            ? "force was cut off"
                          : trial.surely_grows()                 ? "grew"
                          : trial.ring && !trial.surely_decays() ? "grew or not: cannot be told"
                                                                 : ""});
  }
  return table;
}

Rows rig_rows(const Device& device, const RigCheck& check) {
  const RigSession& session = check.session;
  Rows rows;
  if (session.stop == StopReason::none) rows.push_back({"link", "answers every cycle, with zero force"});
  rows.push_back({"watchdog", !check.watchdog_proved   ? "none to prove: there is no firmware that has one"
                              : *check.watchdog_proved ? "proved: after silence the drive had let go"
                                                       : "NOT PROVED: after silence the drive still held its force"});
  if (const std::string filter = filter_text(session.drive); !filter.empty()) {
    rows.push_back({"position filter", filter});
  }
  if (session.nudge) rows.push_back({"sign", nudge_text(*session.nudge, units_of(device.parameters().motion))});
  if (session.timing.delay.count == 0) return rows;
  if (session.driver != "simulated") {  // whose delay is that of its file
    rows.push_back({"delay", fmt::format("{}; for analyze: --set loop.delay={:.3g}",
                                         quantity(session.timing.delay.p50, "s"), session.timing.delay.p50)});
  }
  rows.push_back({"jitter", fmt::format("{}; for simulate: --jitter {:.3g}", quantity(session.timing.latency.p99, "s"),
                                        session.timing.latency.p99)});
  return rows;
}

Rows rig_rows(const Device& device, const RigWall& wall) {
  const Units units = units_of(device.parameters().motion);
  Rows rows{{"wall", fmt::format("K = {}, B = {}", quantity(wall.controller.stiffness, units.stiffness),
                                 quantity(wall.controller.damping, units.damping)) +
                         (wall.damper_on_drive ? ", closed by the drive" : "")}};
  add_predicted(rows, wall.limits, units);
  if (wall.predicted_stable == false) {
    rows.push_back({"UNSTABLE", "by linear analysis, " + unstable_with(*wall.stable_for)});
  }
  if (wall.oscillates) rows.push_back({"OSCILLATES", "it grew, and the wall was taken away at once"});
  if (wall.ring) {
    rows.push_back({"oscillation", fmt::format("{}, {} {} 1/s", crossover_frequency_text(wall.ring->frequency),
                                               wall.ring->growth_rate > 0.0 ? "grows by" : "decays by",
                                               number(std::abs(wall.ring->growth_rate)))});
  }
  rows.push_back({"peaks", fmt::format("{}, {} from the start", quantity(wall.peak_force, units.force),
                                       quantity(wall.peak_position, units.length))});
  return rows;
}

Rows rig_rows(const Device& device, const RigLimit& limit) {
  const Units units = units_of(device.parameters().motion);
  const LimitMeasurement& measured = limit.measured;
  Rows rows;
  if (measured.stiffness) {
    rows.push_back(
        {"K_CR measured", quantity(*measured.stiffness, units.stiffness) +
                              (measured.frequency > 0.0 ? " at " + crossover_frequency_text(measured.frequency)
                                                        : std::string(", its frequency was not read"))});
    if (measured.interval) {
      rows.push_back({"between", fmt::format("{} and {}", quantity(measured.interval->lower, units.stiffness),
                                             quantity(measured.interval->upper, units.stiffness))});
    }
    if (!has_damper_loop(device.loop())) rows.push_back({"for identify", limit_option(measured, device)});
  } else {
    rows.push_back({"K_CR measured", "none"});
  }
  add_predicted(rows, limit.limits, units);
  if (measured.stiffness && limit.predicted.status == StiffnessStatus::finite) {
    rows.push_back(
        {"difference", fmt::format("{:+.2f} %", 100.0 * (*measured.stiffness / limit.predicted.stiffness - 1.0))});
  }
  return rows;
}

}  // namespace zwidth::report
