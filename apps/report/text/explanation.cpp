#include "report/text/explanation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "report/text/quantity.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::report {
namespace {

const DeviceParameters& parameters_of(const AnalysedDevice& analysed) { return analysed.device.parameters(); }

Units device_units(const AnalysedDevice& analysed) { return units_of(parameters_of(analysed).motion); }

std::string stiffness_text(const AnalysedDevice& analysed, double stiffness) {
  return quantity(stiffness, device_units(analysed).stiffness);
}

std::string interval_text(const AnalysedDevice& analysed, const StableInterval& interval) {
  const std::string lower = stiffness_text(analysed, interval.lower);
  if (!interval.upper) return "above " + lower;
  return fmt::format("from {} to {}", lower, stiffness_text(analysed, *interval.upper));
}

/// The intervals that do not begin at K = 0.
std::vector<std::string> higher_intervals(const AnalysedDevice& analysed) {
  std::vector<std::string> texts;
  for (const StableInterval& interval : analysed.analysis.critical.stable_intervals) {
    if (interval.lower > 0.0) texts.push_back(interval_text(analysed, interval));
  }
  return texts;
}

std::string virtual_damper_text(const AnalysedDevice& analysed) {
  const Wall& wall = parameters_of(analysed).wall;
  if (wall.damping <= 0.0) return {};
  std::string text = fmt::format("the virtual damper of {} {}", number(wall.damping), device_units(analysed).damping);
  if (wall.velocity_filter_hz > 0.0) {
    text += fmt::format(" (velocity low-pass at {})", quantity(wall.velocity_filter_hz, "Hz"));
  }
  return text;
}

/// Neither damper nor spring ties any body to ground.
bool is_undamped_against_ground(const DeviceParameters& device) {
  const auto loose = [](const Body& body) { return body.damping == 0.0 && body.stiffness == 0.0; };
  return !device.bodies.empty() && device.user.damping == 0.0 && device.wall.damping == 0.0 &&
         std::all_of(device.bodies.begin(), device.bodies.end(), loose);
}

std::string percent(double fraction) { return number(std::round(1000.0 * fraction) / 10.0) + " %"; }

std::string other_intervals(const AnalysedDevice& analysed) {
  const auto higher = higher_intervals(analysed);
  if (higher.empty()) return {};
  const bool all = higher.size() == analysed.analysis.critical.stable_intervals.size();
  return fmt::format(" Stiffnesses {} are stable{}.", fmt::join(higher, ", and "), all ? "" : " too, unstable below");
}

/// What the device does just above a crossover.
std::string onset_text(const AnalysedDevice& analysed, double frequency, Holder holder) {
  if (frequency == 0.0) return "drifts away without oscillating: " + crossover_frequency_text(frequency);
  const double nyquist = std::numbers::pi / parameters_of(analysed).loop.sampling_period;
  return fmt::format("oscillates {} at about {}{}", holder == Holder::nobody ? "by itself" : "in that hand",
                     quantity(hertz(frequency), "Hz"),
                     frequency < nyquist ? "" : ", the Nyquist frequency: the force alternates at every sample");
}

/// The critical stiffness as a sentence, and who holds.
std::string limit_meaning(const AnalysedDevice& analysed, Holder holder) {
  const CriticalStiffness& critical = analysed.analysis.critical;
  const std::string damper = virtual_damper_text(analysed);
  const std::string condition =
      fmt::format("With {}{}, ", words_of(holder), damper.empty() ? "" : fmt::format(" and {} closed", damper));
  if (critical.status == StiffnessStatus::refused) return condition + "no limit is given.";
  if (critical.status == StiffnessStatus::unbounded) {
    return condition +
           "no wall stiffness makes the loop unstable; it has no phase crossover up to the Nyquist frequency. No real "
           "device does this: check the file for something left out.";
  }
  if (critical.status == StiffnessStatus::none_stable || !critical.limit) {
    std::string text = condition + "the loop is unstable for an arbitrarily small wall stiffness.";
    if (is_undamped_against_ground(parameters_of(analysed))) {
      text +=
          " Nothing damps the device against ground, so the delay of sampling alone drives it: give the bodies "
          "their damping, or the wall a virtual damper.";
    }
    return text + other_intervals(analysed);
  }
  return fmt::format("{}every wall softer than {} is stable. Just above, the device {}.", condition,
                     stiffness_text(analysed, critical.stiffness),
                     onset_text(analysed, critical.limit->frequency, holder)) +
         other_intervals(analysed);
}

/// Degrees by which the filters of the wall turn the phase back at w; below 0 where they lead.
double lag_of_filters(const DeviceParameters& device, double w) {
  double phase = 0.0;
  for (const WallFilter& filter : device.wall.filters) {
    phase += std::arg(response(filter_section(filter, device.loop.sampling_period), w * device.loop.sampling_period));
  }
  return -phase * 180.0 / std::numbers::pi;
}

}  // namespace

std::string display_name(const Device& device) { return device.name().empty() ? "(unnamed device)" : device.name(); }

std::string oscillator_name(const Analysis& analysis, const Oscillator& oscillator) {
  if (oscillator.kind == Oscillator::Kind::rigid_body) {
    if (!analysis.suspended_rigid_body) return "the rigid body";
    return fmt::format("the rigid body on its springs ({})",
                       quantity(hertz(analysis.suspended_rigid_body->frequency), "Hz"));
  }
  const auto index = static_cast<std::size_t>(oscillator.mode) - 1;
  if (index >= analysis.modes.size()) return fmt::format("vibration mode {}", oscillator.mode);
  const Mode& mode = analysis.modes[index];
  return fmt::format("vibration mode {} ({}, damping ratio {})", oscillator.mode, quantity(hertz(mode.frequency), "Hz"),
                     number(mode.damping_ratio));
}

std::string what_turns_unstable(const Device& analysed, const std::string& oscillator, double frequency) {
  if (frequency == 0.0) {
    return oscillator +
           ": a constant force moves the sensed position the other way, and a stiffer wall overcomes what holds it";
  }
  const DeviceParameters& device = analysed.parameters();
  std::vector<std::string> causes = {
      oscillator, fmt::format("the sampling delay of T/2 = {}", quantity(device.loop.sampling_period / 2.0, "s"))};
  if (device.loop.delay > 0.0) causes.push_back(fmt::format("the added delay of {}", quantity(device.loop.delay, "s")));
  if (device.actuator.time_constant > 0.0) {
    causes.push_back(fmt::format("the actuator's lag of {}", quantity(device.actuator.time_constant, "s")));
  }
  if (device.sensor.tracking_bandwidth > 0.0) {
    causes.push_back(
        fmt::format("the drive's tracking of the position at {}", quantity(device.sensor.tracking_bandwidth, "rad/s")));
  }
  if (const double lag = lag_of_filters(device, frequency); lag > 0.0) {
    causes.push_back(fmt::format("the wall's filters, {:.3g}° behind there", lag));
  }
  const std::string last = causes.back();
  causes.pop_back();
  return fmt::format("{} and {}", fmt::join(causes, ", "), last);
}

std::optional<std::string> what_limits(const AnalysedDevice& analysed) {
  const auto& limit = analysed.analysis.critical.limit;
  if (!limit) return std::nullopt;
  return what_turns_unstable(analysed.device, oscillator_name(analysed.analysis, limit->limited_by), limit->frequency);
}

AnalysedDevice with_nobody_holding(const AnalysedDevice& analysed) {
  const auto& alone = analysed.analysis.alone;
  if (!alone) return analysed;
  Analysis analysis;
  analysis.critical = alone->critical;
  analysis.modes = alone->modes;
  analysis.suspended_rigid_body = alone->suspended_rigid_body;
  analysis.trust = analysed.analysis.trust;
  return {device_without_user(analysed.device), std::move(analysis), std::nullopt};
}

std::string critical_stiffness_text(const CriticalStiffness& critical, Motion motion) {
  switch (critical.status) {
    case StiffnessStatus::finite:
      return quantity(critical.stiffness, units_of(motion).stiffness);
    case StiffnessStatus::none_stable:
      return critical.stable_intervals.empty() ? "none: no wall is stable, however soft"
                                               : "none: the softest walls are unstable, stiffer ones are stable";
    case StiffnessStatus::refused:
      return "refused: no number is given";
    case StiffnessStatus::unbounded:
      break;
  }
  return "unbounded: every wall is stable";
}

std::optional<std::string> interval_note(const AnalysedDevice& analysed) {
  const auto& interval = analysed.analysis.interval;
  if (!interval) return std::nullopt;
  const std::string_view unit = units_of(analysed.device.parameters().motion).stiffness;
  const auto end = [&](double stiffness) {
    return std::isfinite(stiffness) ? quantity(stiffness, unit) : std::string("unbounded");
  };
  std::string note = fmt::format("{} to {}, from the uncertainty of the parameters in the file alone",
                                 end(interval->lower), end(interval->upper));
  if (interval->other_mechanism > 0.0) {
    note += fmt::format("; in {:.2g} % of the devices that it allows another mechanism limits",
                        100.0 * interval->other_mechanism);
  }
  const auto& uncertainty = parameters_of(analysed).uncertainty;
  return uncertainty && !uncertainty->warning.empty() ? note + ". NOT TO BE TRUSTED: " + uncertainty->warning : note;
}

/// Whether the limit over all passive users is a lower bound.
static bool is_lower_bound(const Analysis& analysis) {
  return std::ranges::any_of(analysis.remarks, [](const Remark& each) {
    return each.finding && each.finding->code == FindingCode::any_user_limit_scanned &&
           std::ranges::find(each.finding->subjects, Subject{"what", "bound"}) != each.finding->subjects.end();
  });
}

std::optional<std::string> absolute_stability_note(const AnalysedDevice& analysed) {
  if (!analysed.analysis.any_user) {
    const auto is_not_known = [](const Remark& each) {
      return each.finding && each.finding->code == FindingCode::any_grasp_not_known;
    };
    if (std::ranges::any_of(analysed.analysis.remarks, is_not_known)) return "not known: no number is given";
    if (parameters_of(analysed).bodies.size() <= most_bodies_for_absolute_stability) return std::nullopt;
    return fmt::format("not computed above {} bodies", most_bodies_for_absolute_stability);
  }
  const AbsoluteStabilityLimit& limit = *analysed.analysis.any_user;
  if (limit.stiffness == 0.0) return "none: some passive user destabilises every wall";
  if (std::isnan(limit.stiffness)) return "no number is given";
  if (std::isinf(limit.stiffness)) return "unbounded: no passive user destabilises a wall";
  const std::string_view unit = device_units(analysed).stiffness;
  std::string stiffness = (is_lower_bound(analysed.analysis) ? "at least " : "") + quantity(limit.stiffness, unit);
  if (limit.interval) {
    stiffness +=
        fmt::format(" (95 % interval {} to {})", quantity(limit.interval->lower, unit),
                    std::isfinite(limit.interval->upper) ? quantity(limit.interval->upper, unit) : "unbounded");
  }
  if (limit.frequency == 0.0) return stiffness + ", approached by ever heavier users";
  return fmt::format("{}, worst at {}", stiffness, quantity(hertz(limit.frequency), "Hz"));
}

std::optional<std::string> worst_user_note(const AnalysedDevice& analysed) {
  if (!analysed.analysis.worst_user) return std::nullopt;
  const UserNetwork& user = analysed.analysis.worst_user->user;
  const Units units = device_units(analysed);
  std::vector<std::string> parts;
  if (user.mass > 0.0) parts.push_back(fmt::format("a mass of {} {}", number(user.mass), units.mass));
  if (user.stiffness > 0.0) parts.push_back("a spring of " + quantity(user.stiffness, units.stiffness));
  constexpr std::size_t most_named = 3;
  if (user.absorbers.size() > most_named) {
    parts.push_back(fmt::format("{} bodies on springs (--json lists them)", user.absorbers.size()));
  } else {
    for (const auto& [mass, stiffness] : user.absorbers) {
      parts.push_back(
          fmt::format("{} {} on a spring of {}", number(mass), units.mass, quantity(stiffness, units.stiffness)));
    }
  }
  if (parts.empty()) parts.emplace_back("nobody");
  const double above = analysed.analysis.worst_user->critical_stiffness / analysed.analysis.any_user->stiffness - 1.0;
  return fmt::format("{}: {}, {} % above that limit", fmt::join(parts, ", "),
                     quantity(analysed.analysis.worst_user->critical_stiffness, units.stiffness),
                     number(100.0 * std::max(above, 0.0)));
}

std::optional<std::string> user_family_note(const AnalysedDevice& analysed) {
  if (!analysed.analysis.user_family) return std::nullopt;
  const auto& [family, worst, free] = *analysed.analysis.user_family;
  const Units units = device_units(analysed);
  const auto described = [&units](const auto& user, const auto& text) {
    return fmt::format("mass {} {}, damping {} {}, stiffness {} {}", text(user.mass), units.mass, text(user.damping),
                       units.damping, text(user.stiffness), units.stiffness);
  };
  const std::string asked =
      "; asked for: " + described(family, [](const ValueRange& range) {
        return number(range.least) + (range.least < range.greatest ? " to " + number(range.greatest) : "");
      });
  if (std::isinf(worst.critical_stiffness)) {
    return "unbounded: every wall is stable with each of them that was tried" + asked;
  }
  const std::string user = described(worst.user, number);
  if (worst.critical_stiffness == 0.0) return "none: no wall is stable with " + user + asked;
  const std::string nobody = free.status == StiffnessStatus::none_stable ? "none"
                             : free.status == StiffnessStatus::unbounded ? "unbounded"
                                                                         : quantity(free.stiffness, units.stiffness);
  return fmt::format("{}, least found, with {} (nobody: {}){}", quantity(worst.critical_stiffness, units.stiffness),
                     user, nobody, asked);
}

std::string meaning(const AnalysedDevice& analysed) {
  if (analysed.analysis.trust.refused()) return "Neither a limit nor a verdict on a wall is given.";
  const std::string alone = limit_meaning(with_nobody_holding(analysed), Holder::nobody);
  if (!analysed.analysis.limits.user) return alone;
  return fmt::format("{} {} A person lets go: a wall has to be stable with both.", alone,
                     limit_meaning(analysed, Holder::user));
}

std::optional<std::string> rigid_model_note(const AnalysedDevice& analysed, const Detail& detail) {
  const auto& rigid = analysed.analysis.rigid;
  if (!rigid || analysed.device.bodies().size() < 2 || analysed.analysis.trust.refused()) return std::nullopt;
  const Units units = device_units(analysed);
  const std::string ground =
      rigid->stiffness > 0.0 ? fmt::format(", {} to ground", quantity(rigid->stiffness, units.stiffness)) : "";
  const std::string model = fmt::format("With rigid links ({} {}, {} {}{}) the critical stiffness would be ",
                                        number(rigid->mass), units.mass, number(rigid->damping), units.damping, ground);
  const CriticalStiffness& exact = analysed.analysis.critical;
  const double rigid_value = rigid->critical.stiffness;
  const bool unsafe = rigid->error == RigidApproximation::Error::unsafe;
  if (rigid->critical.status != StiffnessStatus::finite || exact.status != StiffnessStatus::finite) {
    const std::string value = rigid->critical.status == StiffnessStatus::finite ? stiffness_text(analysed, rigid_value)
                              : rigid_value == 0.0                              ? "zero"
                                                                                : "unbounded";
    return fmt::format("{}{}{}.", model, value, unsafe ? ": UNSAFE, the links make it lower" : "");
  }
  const double excess = rigid_value / exact.stiffness - 1.0;
  const std::string ratio =
      detail.decibels ? fmt::format(" ({:+.2f} dB)", decibels(rigid_value / exact.stiffness)) : std::string();
  const std::string off = fmt::format("{}{}{}, ", model, stiffness_text(analysed, rigid_value), ratio);
  if (unsafe) return off + percent(excess) + " too high: UNSAFE, a wall designed with the rigid model can oscillate.";
  if (rigid->error == RigidApproximation::Error::none) return off + "the same within 0.05 %.";
  return off + percent(-excess) + " too low: the safe side, but stiffness is given away.";
}

std::optional<std::string> q_criterion_note(const AnalysedDevice& analysed, const Detail& detail) {
  const auto& criterion = analysed.analysis.q_criterion;
  if (!criterion || !(criterion->stiffness > 0.0) || analysed.analysis.trust.refused()) return std::nullopt;
  if (!detail.formulas && !criterion->mode_matters.value_or(false)) return std::nullopt;
  std::string text = fmt::format(
      "Q criterion (an approximation; the crossovers decide): Q = {}, about the least stiffness at which the resonance "
      "can go unstable, over all delays. ",
      stiffness_text(analysed, criterion->stiffness));
  if (parameters_of(analysed).wall.damping > 0.0) text += "Q is of the device without the virtual damper. ";
  const Loop& loop = parameters_of(analysed).loop;
  if (loop.sensed != loop.actuated) {
    return text + "It says nothing about this loop: it is meant for position sensed at the actuated body.";
  }
  if (parameters_of(analysed).wall.damping > 0.0) {
    return text + "It is not compared with the rigid critical stiffness, which is with the damper.";
  }
  const auto& rigid = analysed.analysis.rigid;
  if (!criterion->mode_matters || !rigid) {
    return text + "The device with rigid links has no finite critical stiffness to compare it with.";
  }
  const std::string rigid_value = stiffness_text(analysed, rigid->critical.stiffness);
  if (*criterion->mode_matters) {
    return text +
           fmt::format("It is not above the rigid critical stiffness of {}: the vibration mode matters.", rigid_value);
  }
  if (criterion->is_similar.value_or(false)) {
    return text + fmt::format(
                      "It is above the rigid critical stiffness of {}, but similar: the rigid body limits, the "
                      "mode shifts the limit.",
                      rigid_value);
  }
  return text +
         fmt::format("It is far above the rigid critical stiffness of {}: the mode hardly matters.", rigid_value);
}

std::vector<std::string> encoder_notes(const AnalysedDevice& analysed, const Detail& detail) {
  const Units units = units_of(analysed.device.parameters().motion);
  std::vector<std::string> notes;
  if (const auto& force = analysed.analysis.force_per_count) {
    notes.push_back(fmt::format("one step of the encoder moves the force by {} (K q = {}, damper {})",
                                quantity(force->largest, units.force), quantity(force->stiffness, units.force),
                                quantity(force->damping, units.force)));
  }
  const auto& bound = analysed.analysis.quantisation;
  if (bound && (bound->not_met.empty() || detail.formulas)) {
    notes.push_back(fmt::format(
        "the device's friction dissipates what encoder steps generate up to K = {}: min(2 f_c/q = {}, 2 b/T = {}) "
        "(Abbott & Okamura 2005; passivity of a rigid device with a spring alone, not a limit of stability){}",
        quantity(bound->stiffness, units.stiffness), quantity(bound->friction_stiffness, units.stiffness),
        quantity(bound->damping_stiffness, units.stiffness),
        bound->not_met.empty()
            ? ""
            : fmt::format("; here it does not hold: {}", fmt::join(words_of(bound->not_met), ", "))));
  }
  return notes;
}

std::vector<std::string> caveats(const AnalysedDevice& analysed) {
  const DeviceParameters& device = parameters_of(analysed);
  const Units units = device_units(analysed);
  std::vector<std::string> texts;
  const auto& wall = analysed.analysis.wall;
  for (const Remark& remark : analysed.analysis.remarks) {
    const bool stands_beside_margins = wall.has_value();
    if (remark.severity == Remark::Severity::warning && !stands_beside_margins) texts.push_back(remark_line(remark));
  }
  const User& user = device.user;
  const bool has_limit = analysed.analysis.any_user && analysed.analysis.any_user->stiffness > 0.0 &&
                         std::isfinite(analysed.analysis.any_user->stiffness);
  const std::string held = device.bodies.empty() ? "the tip" : device.bodies[device.loop.held].name;
  if (user.mass > 0.0 || user.damping > 0.0 || user.stiffness > 0.0) {
    texts.push_back(fmt::format("The file's user holds {}: {} {}, {} {}, {}. Another grasp gives another answer.", held,
                                number(user.mass), units.mass, number(user.damping), units.damping,
                                quantity(user.stiffness, units.stiffness)));
  } else if (device.transfer_function) {
    texts.emplace_back("The transfer function is taken as it is: a user who is not in it is left out.");
  } else if (device.bodies.size() == 1) {
    texts.emplace_back(std::string("Nobody holds the device for the critical stiffness.") +
                       (has_limit ? " A wall below the limit for any passive user is stable in every hand." : ""));
  } else {
    texts.emplace_back(std::string("Nobody holds the device for the critical stiffness. A flexible device that is "
                                   "stable alone can be made unstable by a user's grasp") +
                       (has_limit ? ": the limit for any passive user allows for all of them." : "."));
  }
  std::vector<std::string> left_out;
  const bool coulomb =
      std::any_of(device.bodies.begin(), device.bodies.end(), [](const Body& body) { return body.coulomb > 0.0; });
  if (coulomb) left_out.emplace_back("the Coulomb friction in the file");
  if (device.sensor.resolution > 0.0) {
    left_out.push_back(fmt::format("the encoder step of {}", quantity(device.sensor.resolution, units.length)));
  }
  if (device.actuator.force_limit) {
    left_out.push_back(fmt::format("the force limit of {}", quantity(*device.actuator.force_limit, units.force)));
  }
  texts.push_back(left_out.empty() ? "The analysis is linear: friction, encoder steps and force limits are left out."
                                   : fmt::format("The analysis is linear: {} {} left out.",
                                                 fmt::join(left_out, " and "), left_out.size() == 1 ? "is" : "are"));
  return texts;
}

}  // namespace zwidth::report
