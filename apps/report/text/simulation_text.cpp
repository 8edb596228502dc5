#include "report/text/simulation_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "report/text/explanation.hpp"
#include "report/text/holder_limit_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::report {
namespace {

std::string start_text(const Device& device, const Simulation& result) {
  const Units units = units_of(device.parameters().motion);
  const HybridLoopOptions& options = result.loop;
  if (options.initial_position.empty()) return "at rest at 0";
  std::string text;
  for (std::size_t i = 0; i < options.initial_position.size(); ++i) {
    const double velocity = options.initial_velocity.empty() ? 0.0 : options.initial_velocity[i];
    text +=
        fmt::format("{}{} at {}, {}", i == 0 ? "" : "; ", device.bodies()[i].name,
                    quantity(options.initial_position[i], units.length),
                    velocity == 0.0 ? "at rest" : "moving at " + quantity(velocity, std::string(units.length) + "/s"));
  }
  return text;
}

std::string user_text(const Device& device, const Simulation& result) {
  const UserForce& force = result.loop.user_force;
  const std::string unit(units_of(device.parameters().motion).force);
  const std::string from = fmt::format(", from {} on", quantity(force.start, "s"));
  switch (force.kind) {
    case UserForce::Kind::none:
      break;
    case UserForce::Kind::step:
      return "a constant " + quantity(force.amplitude, unit) + from;
    case UserForce::Kind::ramp:
      return "rising by " + quantity(force.amplitude, unit + "/s") + from;
    case UserForce::Kind::sine:
      return fmt::format("a sine of {} at {}{}", quantity(force.amplitude, unit),
                         quantity(hertz(force.frequency), "Hz"), from);
    case UserForce::Kind::recorded:
      return fmt::format("recorded, {} samples every {}{}", force.samples.size(), quantity(force.period, "s"), from);
  }
  return "none";
}

std::string faults_text(const Faults& faults) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (faults.lost_sample_probability > 0.0)
    add(fmt::format("{:.3g} % of samples lost", 100.0 * faults.lost_sample_probability));
  if (faults.sampling_jitter > 0.0) add(fmt::format("samples up to {} late", quantity(faults.sampling_jitter, "s")));
  if (faults.overrun_probability > 0.0) {
    add(fmt::format("{:.3g} % of forces {} late", 100.0 * faults.overrun_probability,
                    quantity(faults.overrun_delay, "s")));
  }
  return text.empty() ? text : text + fmt::format(" (seed {})", faults.seed);
}

std::string energy_text(const Simulation& result) {
  // 0 is what rounding makes of it.
  return fmt::format("{} at the end, {} at most; above 0 the sampled wall was active: it gave more than it took",
                     quantity(*result.generated_energy, "J"), quantity(result.peak_generated_energy, "J"));
}

std::string oscillation_text(const Oscillation& oscillation, Motion motion) {
  return fmt::format("{} ({} rad/s), amplitude {}", quantity(hertz(oscillation.frequency), "Hz"),
                     number(oscillation.frequency), quantity(oscillation.amplitude, units_of(motion).length));
}

/// "the envelope halves every 5.5 s".
std::string envelope_text(double growth_rate) {
  return fmt::format("the envelope {} every {}", growth_rate < 0.0 ? "halves" : "doubles",
                     quantity(std::numbers::ln2 / std::abs(growth_rate), "s"));
}

std::string_view name_of(NonlinearPart part) {
  switch (part) {
    case NonlinearPart::coulomb_friction:
      return "Coulomb friction";
    case NonlinearPart::quantisation_step:
      return "the encoder step";
    case NonlinearPart::force_limit:
      return "the force limit";
    case NonlinearPart::leaving_wall:
      return "leaving the wall";
    case NonlinearPart::lost_samples:
      return "lost samples";
    case NonlinearPart::sampling_jitter:
      return "sampling jitter";
    case NonlinearPart::late_forces:
      break;
  }
  return "late forces";
}

std::string quantisation_force_text(const QuantisationForce& quantisation_force, Motion motion) {
  return fmt::format("{} either way at {}", quantity(quantisation_force.amplitude, units_of(motion).force),
                     quantity(hertz(quantisation_force.frequency), "Hz"));
}

}  // namespace

std::string simulated_wall_text(const Device& device, const Simulation& result) {
  const ControllerOptions& wall = result.loop.controller;
  const Units units = units_of(device.parameters().motion);
  std::string text = quantity(wall.stiffness, units.stiffness);
  if (wall.damping > 0.0) {
    text += " and " + damper_apart_text(device, wall.damping).value_or(quantity(wall.damping, units.damping));
  }
  if (wall.damping > 0.0 && wall.velocity_filter_hz > 0.0) {
    text += fmt::format(" (velocity low-pass at {})", quantity(wall.velocity_filter_hz, "Hz"));
  }
  if (const auto filters = wall_filters_text(device.parameters().wall)) text += ", through " + *filters;
  return text + fmt::format(", from {} on, {}", quantity(wall.position, units.length),
                            wall.contact == ControllerOptions::Contact::unilateral
                                ? "pushing only"
                                : "pulling back from the other side too");
}

std::string verdict_sentence(const Device& device, const Simulation& result) {
  const Motion motion = device.parameters().motion;
  const std::string oscillation = result.oscillation ? oscillation_text(*result.oscillation, motion) : "";
  switch (result.verdict) {
    case LoopVerdict::settles:
      if (!result.oscillation) {
        if (!result.encoder_chatters) return "SETTLES: the device comes to rest";
        return "SETTLES to within the encoder step, but the force chatters by " +
               quantisation_force_text(*result.quantisation_force, motion);
      }
      if (result.growth_rate && *result.growth_rate < 0.0 &&
          result.oscillation->amplitude > device.parameters().sensor.resolution) {
        return fmt::format("SETTLES: the oscillation dies out, {}; at the end {}", envelope_text(*result.growth_rate),
                           oscillation);
      }
      return fmt::format("SETTLES to within the encoder step of {}; what is left: {}",
                         quantity(device.parameters().sensor.resolution, units_of(motion).length), oscillation);
    case LoopVerdict::limit_cycle:
      return "LIMIT CYCLE: the oscillation neither grows nor dies out by 1 % over the second half of the run: " +
             oscillation;
    case LoopVerdict::forced:
      return "FOLLOWS THE USER: a steady oscillation at the frequency of the user's force: " + oscillation +
             (result.growth_rate && *result.growth_rate < 0.0
                  ? fmt::format("; of the loop's own oscillation beside it, {}", envelope_text(*result.growth_rate))
                  : "");
    case LoopVerdict::unstable:
      if (!result.growth_rate)
        return result.diverged ? "UNSTABLE: the position passes every bound"
                               : "UNSTABLE: the motion grows threefold or more from quarter to quarter of the run";
      return fmt::format("UNSTABLE: an oscillation grows, {}; at the end {}", envelope_text(*result.growth_rate),
                         oscillation);
    case LoopVerdict::drifts:
      return fmt::format("DRIFTS: {} within the run, but the device moves on; it ends at {}",
                         result.encoder_chatters ? "no oscillation but the ripple of " +
                                                       quantisation_force_text(*result.quantisation_force, motion)
                                                 : "no oscillation",
                         quantity(result.final_position, units_of(motion).length));
    case LoopVerdict::undecided:
      break;
  }
  return "UNDECIDED: neither rest nor a steady, growing or decaying oscillation within the run";
}

std::string linear_answer(const Device& device, const Simulation& result) {
  const LinearAnswer& linear = result.linear;
  const Holder holder = holder_of(linear.limits);
  std::string text = fmt::format("critical stiffness with {}: {}", words_of(holder),
                                 critical_stiffness_text(linear.critical, device.parameters().motion));
  if (linear.limits.user) {
    text += fmt::format(" ({} with {})",
                        holder_limit_text(linear.limits.nobody, units_of(device.parameters().motion).stiffness),
                        words_of(Holder::nobody));
  }
  if (!linear.wall_stable || result.loop.controller.stiffness == 0.0) return text;
  if (linear.wall_share) text += fmt::format("; the wall has {:.3g} % of it", 100.0 * *linear.wall_share);
  text += *linear.wall_stable ? ": stable" : ": UNSTABLE";
  if (linear.limits.user && linear.stable_for && *linear.wall_stable && !linear.stable_for->nobody) {
    text += ", but UNSTABLE " + unstable_with(*linear.stable_for);
  }
  if (linear.agrees == false && !result.nonlinear_parts.empty()) {
    std::vector<std::string_view> names;
    for (const NonlinearPart part : result.nonlinear_parts) names.push_back(name_of(part));
    text += fmt::format(". The difference to the run: linear analysis leaves out {}", fmt::join(names, ", "));
  }
  return text;
}

std::string simulation_text(const Device& device, const Simulation& result) {
  const Units units = units_of(device.parameters().motion);
  const double period = device.loop().sampling_period;
  const bool has_wall = result.generated_energy.has_value();
  std::string text = shortened(display_name(device), line_width) + "\n";
  if (const auto note = trust_note(result.trust)) text += labelled("  trust", "of the limit: " + *note);
  text += labelled("  simulated",
                   fmt::format("{}, {} samples at {}", quantity(static_cast<double>(result.samples) * period, "s"),
                               result.samples, quantity(1.0 / period, "Hz")));
  if (has_wall) text += labelled("  wall", simulated_wall_text(device, result));
  text += labelled("  start", start_text(device, result));
  if (result.loop.user_force.kind != UserForce::Kind::none)
    text += labelled("  user's force", user_text(device, result));
  if (const std::string faults = faults_text(result.loop.faults); !faults.empty()) text += labelled("  faults", faults);
  text += "\n" + wrap(verdict_sentence(device, result) + ".", line_width, 0) + "\n";
  if (result.settling_time) {
    text += labelled("  settled after",
                     fmt::format("{} (to 2 % of its largest excursion)", quantity(*result.settling_time, "s")));
  }
  text += labelled("  ends at", quantity(result.final_position, units.length));
  if (has_wall) {
    text += labelled("  peak penetration",
                     result.peak_penetration > 0.0 ? quantity(result.peak_penetration, units.length) : "none");
    text += labelled("  generated energy", energy_text(result));
  }
  if (result.friction_events > 0) text += labelled("  stick-slip", fmt::format("{} instants", result.friction_events));
  text += labelled("  linear answer", linear_answer(device, result));
  for (const Remark& remark : result.remarks) {
    text += labelled("  note", remark_line(remark));
  }
  return text;
}

}  // namespace zwidth::report
