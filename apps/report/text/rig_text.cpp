#include "report/text/rig_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "report/text/findings_text.hpp"
#include "report/text/frf_text.hpp"
#include "report/text/holder_limit_text.hpp"
#include "report/text/identification_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/relay_text.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::report {
namespace {

std::string rig_heading(const Device& device, std::string_view what, const RigSession& session) {
  const std::string stopped =
      session.stop == StopReason::none
          ? ""
          : labelled("  STOPPED", fmt::format("after {}: {}", quantity(session.stopped_at, "s"), explanation(session)));
  return shortened(fmt::format("{}: {}", what, device.name()), line_width) + "\n" + stopped;
}

void add_latency(TextTable& table, const std::string& name, const LatencySummary& summary) {
  if (summary.count == 0) return;
  const auto text = [](double value) { return quantity(value, "s"); };
  table.rows.push_back(
      {name, text(summary.p50), text(summary.p99), text(summary.p999), text(summary.p9999), text(summary.max)});
}

std::string session_text(const RigSession& session) {
  const LoopTiming& timing = session.timing;
  std::string text = "\nSession\n";
  text += labelled("  driver",
                   session.driver + (session.lock_step ? ", in lock step: its time moves with the cycles" : ""));
  text += labelled("  cycles", fmt::format("{} of {}, {} missed, {} without a position", timing.cycles,
                                           quantity(session.sampling_period, "s"), timing.missed, timing.unanswered));
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::right, Align::right},
                  {{"", "p50", "p99", "p99.9", "p99.99", "largest"}}};
  add_latency(table, "latency", timing.latency);
  add_latency(table, "period", timing.period);
  add_latency(table, "cycle", timing.body);
  text += layout(table);
  if (!session.remarks.empty()) text += remarks_text(session.remarks);
  return text;
}

std::string predicted_text(const HolderLimit& limit, const Units& units) {
  const std::string text = holder_limit_text(limit, units.stiffness);
  return limit.frequency ? fmt::format("{} at {}", text, crossover_frequency_text(*limit.frequency)) : text;
}

/// What the file predicts, a line for each holder.
std::string predicted_lines(const HoldingLimits& limits, const Units& units) {
  std::string lines = labelled("  K_CR predicted",
                               fmt::format("{}: {}", words_of(Holder::nobody), predicted_text(limits.nobody, units)));
  const auto add = [&](Holder holder, const std::optional<HolderLimit>& limit) {
    if (limit) lines += labelled("", fmt::format("{}: {}", words_of(holder), predicted_text(*limit, units)));
  };
  add(Holder::user, limits.user);
  add(Holder::any_user, limits.any_user);
  return lines;
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

std::string trial_rows(const LimitMeasurement& measured, const Units& units) {
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
  return layout(table);
}

/// What identify takes it as, whose walls are of one rate.
std::string limit_option(const LimitMeasurement& measured, const Device& device) {
  const double damping = device.parameters().wall.damping;
  return fmt::format("--limit \"K={:.4g}{}{}\"", *measured.stiffness,
                     damping > 0.0 ? fmt::format(", B={:.4g}", damping) : "",
                     measured.frequency > 0.0 ? fmt::format(", hz={:.4g}", hertz(measured.frequency)) : "");
}

}  // namespace

std::string rig_text(const Device& device, const RigCheck& check) {
  const RigSession& session = check.session;
  std::string text = rig_heading(device, "Rig check", session);
  text += trust_lines(check.trust);
  if (session.stop == StopReason::none) text += labelled("  link", "answers every cycle, with zero force");
  if (check.watchdog_proved) {
    text += labelled("  watchdog", *check.watchdog_proved ? "proved: after silence the drive had let go"
                                                          : "NOT PROVED: after silence the drive still held its force");
  } else {
    text += labelled("  watchdog", "none to prove: there is no firmware that has one");
  }
  if (session.nudge) text += labelled("  sign", nudge_text(*session.nudge, units_of(device.parameters().motion)));
  if (session.timing.delay.count > 0) {
    if (session.driver != "simulated") {  // whose delay is that of its file
      text += labelled("  delay", fmt::format("{}; for analyze: --set loop.delay={:.3g}",
                                              quantity(session.timing.delay.p50, "s"), session.timing.delay.p50));
    }
    text += labelled("  jitter", fmt::format("{}; for simulate: --jitter {:.3g}",
                                             quantity(session.timing.latency.p99, "s"), session.timing.latency.p99));
  }
  return text + session_text(session);
}

std::string rig_text(const Device& device, const RigMeasurement& measurement) {
  std::string text = rig_heading(device, "Rig measurement", measurement.session);
  if (!measurement.response) return text + trust_lines(measurement.trust) + session_text(measurement.session);
  MeasuredResponse response = *measurement.response;
  response.trust = measurement.trust;  // the response's, and the device's
  return text + frf_text(response, results::frf_units(device)) + session_text(measurement.session);
}

std::string rig_text(const Device& device, const RigIdentification& identification) {
  std::string text = rig_heading(device, "Identified on the rig", identification.measurement.session);
  const RigSession& session = identification.measurement.session;
  if (!identification.identification) return text + trust_lines(identification.trust) + session_text(session);
  Identification identified = *identification.identification;
  identified.trust = identification.trust;  // the fit's, and the device's
  return text + identification_text(identified) + session_text(session);
}

std::string rig_text(const Device& device, const RigRelay& relay) {
  std::string text = rig_heading(device, "Relay experiment on the rig", relay.session);
  if (relay.relay) text += relay_text(*relay.relay);
  return text + session_text(relay.session);
}

std::string rig_text(const Device& device, const RigWall& wall) {
  const Units units = units_of(device.parameters().motion);
  std::string text = rig_heading(device, "Wall on the rig", wall.session);
  text += labelled("  wall", fmt::format("K = {}, B = {}", quantity(wall.controller.stiffness, units.stiffness),
                                         quantity(wall.controller.damping, units.damping)) +
                                 (wall.damper_on_drive ? ", closed by the drive" : ""));
  text += predicted_lines(wall.limits, units);
  text += trust_lines(wall.trust, "wall");
  if (wall.predicted_stable == false) {
    text += labelled("  UNSTABLE", "by linear analysis, " + unstable_with(*wall.stable_for));
  }
  if (wall.oscillates) {
    text += labelled("  OSCILLATES", "it grew, and the wall was taken away at once");
  }
  if (wall.ring) {
    text += labelled("  oscillation", fmt::format("{}, {} {} 1/s", crossover_frequency_text(wall.ring->frequency),
                                                  wall.ring->growth_rate > 0.0 ? "grows by" : "decays by",
                                                  number(std::abs(wall.ring->growth_rate))));
  }
  text += labelled("  peaks", fmt::format("{}, {} from the start", quantity(wall.peak_force, units.force),
                                          quantity(wall.peak_position, units.length)));
  return text + session_text(wall.session);
}

std::string rig_text(const Device& device, const RigLimit& limit) {
  const Units units = units_of(device.parameters().motion);
  const LimitMeasurement& measured = limit.measured;
  std::string text = rig_heading(device, "Limit on the rig", limit.session);
  if (measured.stiffness) {
    text += labelled("  K_CR measured",
                     quantity(*measured.stiffness, units.stiffness) +
                         (measured.frequency > 0.0 ? " at " + crossover_frequency_text(measured.frequency)
                                                   : std::string(", its frequency was not read")));
    if (measured.interval) {
      text += labelled("  between", fmt::format("{} and {}", quantity(measured.interval->lower, units.stiffness),
                                                quantity(measured.interval->upper, units.stiffness)));
    }
    if (!has_damper_loop(device.loop())) text += labelled("  for identify", limit_option(measured, device));
  } else {
    text += labelled("  K_CR measured", "none");
  }
  text += predicted_lines(limit.limits, units);
  if (measured.stiffness && limit.predicted.status == StiffnessStatus::finite) {
    text += labelled("  difference",
                     fmt::format("{:+.2f} %", 100.0 * (*measured.stiffness / limit.predicted.stiffness - 1.0)));
  }
  for (const Remark& remark : limit.remarks) text += labelled("", remark_line(remark));
  text += trust_lines(limit.trust);
  return text + "\nTrials, each after a knock of " + quantity(limit.impulse, units.force) + "\n" +
         trial_rows(measured, units) + session_text(limit.session);
}

}  // namespace zwidth::report
