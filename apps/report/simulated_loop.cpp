#include "report/simulated_loop.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

Remark note(std::string what, std::string meaning) {
  return {Remark::Severity::note, std::move(what), std::move(meaning)};
}

Remark warning(std::string what, std::string meaning) {
  return {Remark::Severity::warning, std::move(what), std::move(meaning)};
}

bool has_wall(const SimulatedLoop& loop) { return loop.options.loop.controller.kind == ControllerOptions::Kind::wall; }

double simulated_time(const SimulatedLoop& loop) {
  return static_cast<double>(loop.result.samples) * loop.analysed.device.loop().sampling_period;
}

/// When the user's force has its last change, s; absent where it never ends.
std::optional<double> end_of(const UserForce& force) {
  if (force.kind != UserForce::Kind::recorded) return std::nullopt;
  return force.start + force.period * static_cast<double>(force.samples.size() - 1);
}

constexpr const char* encoder_step = "the encoder step";

/// What moves the loop and is not linear.
std::vector<std::string> nonlinear_parts(const SimulatedLoop& loop) {
  const DeviceParameters& device = loop.analysed.device.parameters();
  const Faults& faults = loop.options.loop.faults;
  std::vector<std::string> parts;
  if (std::any_of(device.bodies.begin(), device.bodies.end(), [](const Body& body) { return body.coulomb > 0.0; })) {
    parts.emplace_back("Coulomb friction");
  }
  if (device.sensor.resolution > 0.0) parts.emplace_back(encoder_step);
  if (device.actuator.force_limit) parts.emplace_back("the force limit");
  if (loop.options.loop.controller.contact == ControllerOptions::Contact::unilateral) {
    parts.emplace_back("leaving the wall");
  }
  if (faults.lost_sample_probability > 0.0) parts.emplace_back("lost samples");
  if (faults.sampling_jitter > 0.0) parts.emplace_back("sampling jitter");
  if (faults.overrun_probability > 0.0) parts.emplace_back("late forces");
  return parts;
}

/// Linear analysis finds a pole outside the unit circle, and nothing in the loop could hold its oscillation down: an
/// encoder's step does not.
bool must_grow(const SimulatedLoop& loop) {
  const auto& wall = loop.analysed.analysis.wall;
  std::vector<std::string> parts = nonlinear_parts(loop);
  std::erase(parts, encoder_step);
  return has_wall(loop) && wall && wall->spectral_radius > 1.0 && parts.empty();
}

std::vector<Remark> remarks_of(const SimulatedLoop& loop) {
  const Simulation& result = loop.result;
  const Units units = units_of(loop.analysed.device.parameters().motion);
  const ControllerOptions& wall = loop.options.loop.controller;
  const UserForce& force = loop.options.loop.user_force;
  std::vector<Remark> remarks;
  if (!has_wall(loop)) {
    remarks.push_back(note("there is no wall: the device moves freely", "set wall.stiffness to render one"));
  } else if (wall.contact == ControllerOptions::Contact::unilateral && result.peak_penetration == 0.0) {
    remarks.push_back(warning("the device never touches the wall", "the verdict is about the free device"));
  }
  const double start = loop.options.loop.initial_position.empty()
                           ? 0.0
                           : loop.options.loop.initial_position[loop.analysed.device.loop().sensed];
  if (has_wall(loop) && wall.contact == ControllerOptions::Contact::unilateral && start > wall.position) {
    remarks.push_back(
        note(fmt::format("the device starts {} inside the wall", quantity(start - wall.position, units.length)),
             "the wall pushes it out"));
  }
  if (simulated_time(loop) < loop.options.duration - loop.analysed.device.loop().sampling_period) {
    remarks.push_back(
        note(fmt::format("the run ended after {}: the position passed {}", quantity(simulated_time(loop), "s"),
                         quantity(loop.options.divergence, units.length)),
             "the later motion is not simulated"));
  }
  if (const auto end = end_of(force); end && *end > force.start + 0.5 * (loop.options.duration - force.start)) {
    remarks.push_back(note("the recorded force acts in the part of the run that is judged",
                           "the verdict is about the device under that force"));
  }
  if (result.verdict == LoopVerdict::undecided) {
    remarks.push_back(must_grow(loop)
                          ? warning("nothing grows within this run, but by linear analysis something does",
                                    "a slowly growing oscillation may hide under others: simulate longer with "
                                    "--duration")
                          : warning("the run holds too few oscillations to tell", "simulate longer with --duration"));
  }
  if (result.overloaded_steps > 0) {
    remarks.push_back(
        warning(fmt::format("{} steps had too many stick-slip instants to follow", result.overloaded_steps),
                "the motion is approximate there"));
  }
  return remarks;
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

}  // namespace

SimulatedLoop simulated_loop(AnalysedDevice analysed, const SimulationOptions& options, const Progress& progress) {
  Simulation result = simulate(analysed.device, options, progress);
  SimulatedLoop loop{std::move(analysed), options, std::move(result), {}};
  const bool hides_growth =
      must_grow(loop) && (loop.result.verdict == LoopVerdict::settles || loop.result.verdict == LoopVerdict::forced);
  if (hides_growth) loop.result.verdict = LoopVerdict::undecided;
  loop.remarks = remarks_of(loop);
  return loop;
}

std::string verdict_name(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::settles:
      return "settles";
    case LoopVerdict::limit_cycle:
      return "limit_cycle";
    case LoopVerdict::forced:
      return "forced";
    case LoopVerdict::unstable:
      return "unstable";
    case LoopVerdict::drifts:
      return "drifts";
    case LoopVerdict::undecided:
      break;
  }
  return "undecided";
}

std::string verdict_sentence(const SimulatedLoop& loop) {
  const Simulation& result = loop.result;
  const Motion motion = loop.analysed.device.parameters().motion;
  const std::string oscillation = result.oscillation ? oscillation_text(*result.oscillation, motion) : "";
  switch (result.verdict) {
    case LoopVerdict::settles:
      if (!result.oscillation) return "SETTLES: the device comes to rest";
      if (result.growth_rate && *result.growth_rate < 0.0 &&
          result.oscillation->amplitude > loop.analysed.device.parameters().sensor.resolution) {
        return fmt::format("SETTLES: the oscillation dies out, {}; at the end {}", envelope_text(*result.growth_rate),
                           oscillation);
      }
      return fmt::format("SETTLES to within the encoder step of {}; what is left: {}",
                         quantity(loop.analysed.device.parameters().sensor.resolution, units_of(motion).length),
                         oscillation);
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
        return simulated_time(loop) < loop.options.duration - loop.analysed.device.loop().sampling_period
                   ? "UNSTABLE: the position passes every bound"
                   : "UNSTABLE: the motion grows threefold or more from quarter to quarter of the run";
      return fmt::format("UNSTABLE: an oscillation grows, {}; at the end {}", envelope_text(*result.growth_rate),
                         oscillation);
    case LoopVerdict::drifts:
      return fmt::format("DRIFTS: no oscillation within the run, but the device moves on; it ends at {}",
                         quantity(result.final_position, units_of(motion).length));
    case LoopVerdict::undecided:
      break;
  }
  return "UNDECIDED: neither rest nor a steady, growing or decaying oscillation within the run";
}

std::string linear_answer(const SimulatedLoop& loop) {
  const Analysis& analysis = loop.analysed.analysis;
  const Motion motion = loop.analysed.device.parameters().motion;
  const std::string critical = "critical stiffness " + critical_stiffness_text(analysis.critical, motion);
  if (!analysis.wall || analysis.wall->stiffness == 0.0) return critical;
  const bool stable = analysis.wall->stable;
  std::string text = critical;
  if (analysis.critical.status == StiffnessStatus::finite) {
    text +=
        fmt::format("; the wall has {:.3g} % of it", 100.0 * analysis.wall->stiffness / analysis.critical.stiffness);
  }
  text += stable ? ": stable" : ": UNSTABLE";
  const LoopVerdict verdict = loop.result.verdict;
  const bool moves_on = verdict == LoopVerdict::limit_cycle || verdict == LoopVerdict::unstable;
  const std::vector<std::string> parts = nonlinear_parts(loop);
  if ((stable ? moves_on : !moves_on) && verdict != LoopVerdict::undecided && !parts.empty()) {
    text += fmt::format(". The difference to the run: linear analysis leaves out {}", fmt::join(parts, ", "));
  }
  return text;
}

}  // namespace zwidth::report
